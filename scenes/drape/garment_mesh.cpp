#include "scenes/drape/garment_mesh.h"

#include <algorithm>
#include <utility>

#include "garment/pattern/mesh/gathers.h"

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

bool is_texture(const std::vector<FlatTriangle>& rest, const garment::PatternMesh& mesh)
{
    for (size_t t = 0; t < rest.size(); ++t)
        for (int k = 0; k < 3; ++k)
            if (rest[t][size_t(k)] != mesh.uv[size_t(mesh.triangles[t][k])])
                return false;
    return true;
}

} // namespace

GarmentMesh::GarmentMesh(const garment::Pattern& pattern, double edge, double least)
    : panels(mesh_panels(pattern, edge, least)), sewn(garment::sewn_mesh(panels)), folds(pattern)
{
    for (const garment::Panel& panel : pattern.panels)
        panel_names.push_back(panel.name);
    rest = garment::gathered_rest(pattern, panels);
    if (is_texture(rest, panels))
        rest.clear();
}

GarmentSurface GarmentMesh::surface(const garment::SewnMesh& partly, View<const Vec3> x) const
{
    GarmentSurface surface;
    ObjMesh& mesh = surface.mesh;
    mesh.positions.assign(x.begin(), x.end());
    mesh.texture_coordinates = panels.uv;
    for (size_t t = 0; t < partly.triangles.size(); ++t) {
        const Triangle &corner = partly.triangles[t], &flat = partly.corners[t];
        mesh.polygons.push_back({corner[0], corner[1], corner[2]});
        mesh.polygon_uvs.push_back({flat[0], flat[1], flat[2]});
    }
    for (size_t p = 0; p < panel_names.size(); ++p)
        begin_group(mesh, panel_names[p], panels.first_triangle[p]);
    surface.rest = rest;
    for (size_t t = 0; t < surface.rest.size(); ++t)
        if (partly.is_turned[size_t(panels.panel_of_triangle(int(t)))])
            std::swap(surface.rest[t][1], surface.rest[t][2]);
    surface.folds = folds.on(panels, partly);
    return surface;
}

ObjMesh GarmentSurface::rest_mesh() const
{
    ObjMesh flat = mesh;
    flat.texture_coordinates.clear();
    for (size_t t = 0; t < rest.size(); ++t) {
        const int first = int(flat.texture_coordinates.size());
        flat.texture_coordinates.insert(flat.texture_coordinates.end(), rest[t].begin(), rest[t].end());
        flat.polygon_uvs[t] = {first, first + 1, first + 2};
    }
    return flat;
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
