#include "scenes/drape/garment_mesh.h"

#include <algorithm>

namespace toile::scenes {

namespace {

garment::PatternMesh mesh_panels(const garment::Pattern& pattern, double edge, double least)
{
    garment::PatternMeshSettings settings;
    settings.edge = edge;
    for (const garment::Panel& panel : pattern.panels)
        settings.panel_edges.push_back(std::max(panel.edge_length.value_or(edge), least));
    return garment::mesh_pattern(pattern, settings);
}

} // namespace

GarmentMesh::GarmentMesh(const garment::Pattern& pattern, double edge, double least)
    : panels(mesh_panels(pattern, edge, least)), sewn(garment::sewn_mesh(panels))
{
    for (const garment::Panel& panel : pattern.panels)
        panel_names.push_back(panel.name);
}

ObjMesh GarmentMesh::surface(View<const Vec3> x) const { return textured_surface(*this, sewn, x); }

std::vector<int> GarmentMesh::labelled(const garment::Pattern& pattern, const std::string& label) const
{
    std::vector<int> vertices;
    for (size_t p = 0; p < pattern.panels.size(); ++p)
        for (size_t e = 0; e < pattern.panels[p].edges.size(); ++e)
            if (pattern.panels[p].edges[e].label == label)
                for (const garment::EdgeVertex& at : panels.edge_vertices[p][e])
                    vertices.push_back(sewn.welded_of[at.vertex]);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

ObjMesh textured_surface(const GarmentMesh& garment, const garment::SewnMesh& sewn, View<const Vec3> x)
{
    ObjMesh mesh;
    mesh.positions.assign(x.begin(), x.end());
    mesh.texture_coordinates = garment.panels.uv;
    for (size_t t = 0; t < sewn.triangles.size(); ++t) {
        const Triangle &corner = sewn.triangles[t], &flat = sewn.corners[t];
        mesh.polygons.push_back({corner[0], corner[1], corner[2]});
        mesh.polygon_uvs.push_back({flat[0], flat[1], flat[2]});
    }
    for (size_t p = 0; p < garment.panel_names.size(); ++p)
        begin_group(mesh, garment.panel_names[p], garment.panels.first_triangle[p]);
    return mesh;
}

std::vector<Vec3> weld(const garment::SewnMesh& sewn, View<const Vec3> x)
{
    std::vector<Vec3> welded;
    for (const std::vector<int>& members : sewn.members) {
        Vec3 sum = Vec3::Zero();
        for (const int v : members)
            sum += x[v];
        welded.push_back(sum / double(members.size()));
    }
    return welded;
}

std::vector<Vec3> unweld(const garment::SewnMesh& sewn, View<const Vec3> welded)
{
    std::vector<Vec3> x;
    for (const int v : sewn.welded_of)
        x.push_back(welded[v]);
    return x;
}

} // namespace toile::scenes
