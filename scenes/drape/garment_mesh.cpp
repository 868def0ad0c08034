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

ObjMesh with_texture(const std::vector<Triangle>& triangles, const std::vector<Triangle>& corners,
                     const std::vector<Vec2>& uv, View<const Vec3> x)
{
    ObjMesh mesh;
    mesh.positions.assign(x.begin(), x.end());
    mesh.texture_coordinates = uv;
    for (size_t t = 0; t < triangles.size(); ++t) {
        mesh.polygons.push_back({triangles[t][0], triangles[t][1], triangles[t][2]});
        mesh.polygon_uvs.push_back({corners[t][0], corners[t][1], corners[t][2]});
    }
    return mesh;
}

} // namespace

GarmentMesh::GarmentMesh(const garment::Pattern& pattern, double edge, double least)
    : panels(mesh_panels(pattern, edge, least)), sewn(garment::sewn_mesh(panels))
{
    for (const garment::Panel& panel : pattern.panels)
        panel_names.push_back(panel.name);
}

void GarmentMesh::add_groups(ObjMesh& mesh) const
{
    for (size_t p = 0; p < panel_names.size(); ++p)
        begin_group(mesh, panel_names[p], panels.first_triangle[p]);
}

ObjMesh GarmentMesh::unsewn(View<const Vec3> x) const
{
    // Panels that are sewn front to back are turned, as in the welded surface.
    ObjMesh mesh = with_texture(sewn.corners, sewn.corners, panels.uv, x);
    for (const auto& seam : panels.stitches)
        mesh.lines.insert(mesh.lines.end(), seam.begin(), seam.end());
    add_groups(mesh);
    return mesh;
}

ObjMesh GarmentMesh::welded(View<const Vec3> x) const
{
    ObjMesh mesh = with_texture(sewn.triangles, sewn.corners, panels.uv, x);
    add_groups(mesh);
    return mesh;
}

std::vector<Vec3> GarmentMesh::weld(View<const Vec3> x) const
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

std::vector<Vec3> GarmentMesh::unweld(View<const Vec3> welded) const
{
    std::vector<Vec3> x;
    for (const int v : sewn.welded_of)
        x.push_back(welded[v]);
    return x;
}

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

std::vector<double> GarmentMesh::seam_gaps(View<const Vec3> x) const
{
    std::vector<double> gaps;
    for (const auto& seam : panels.stitches) {
        double largest = 0.0;
        for (const auto& [a, b] : seam)
            largest = std::max(largest, (x[a] - x[b]).norm());
        gaps.push_back(largest);
    }
    return gaps;
}

} // namespace toile::scenes
