#include "apps/toile/caches/exported_mesh.h"

#include <numeric>
#include <utility>

namespace toile::app {

ExportedMesh::ExportedMesh(const exports::CacheMesh& whole, const Parts& parts,
                           const std::vector<double>& thickness)
    : vertex_count_(whole.vertex_count)
{
    const std::vector<exports::MeshPart> groups =
        parts.weld ? std::vector<exports::MeshPart>{} : exports::parts_of(whole.faces);
    if (groups.size() > 1) {
        for (const exports::MeshPart& group : groups)
            add_part({group.name, whole.name, int(group.vertices.size()), group.faces, whole.attributes},
                     group.vertices, thickness);
        if (parts.has_panels)
            number_panels(groups);
        return;
    }
    std::vector<int> all(size_t(whole.vertex_count));
    std::iota(all.begin(), all.end(), 0);
    add_part(whole, std::move(all), thickness);
    if (parts.has_panels)
        meshes_.front().panels = exports::face_panels(meshes_.front().faces);
}

/// Each mesh is a panel.
void ExportedMesh::number_panels(const std::vector<exports::MeshPart>& groups)
{
    std::vector<std::string> names;
    names.reserve(groups.size());
    for (const exports::MeshPart& group : groups)
        names.push_back(group.name);
    for (size_t m = 0; m < meshes_.size(); ++m)
        meshes_[m].panels = {std::vector<int>(meshes_[m].faces.polygons.size(), int(m)), names};
}

void ExportedMesh::add_part(exports::CacheMesh mesh, std::vector<int> vertices,
                            const std::vector<double>& thickness)
{
    Part part{std::move(vertices), std::nullopt};
    if (!thickness.empty()) {
        std::vector<double> of_part;
        for (const int v : part.vertices)
            of_part.push_back(thickness[size_t(v)]);
        part.closed.emplace(mesh.faces, std::move(of_part));
        mesh.vertex_count *= 2;
        mesh.faces = part.closed->faces();
    }
    meshes_.push_back(std::move(mesh));
    parts_.push_back(std::move(part));
}

void ExportedMesh::append(View<const Vec3> x, std::vector<Vec3>& positions) const
{
    for (const Part& part : parts_) {
        std::vector<Vec3> of_part;
        of_part.reserve(part.vertices.size());
        for (const int v : part.vertices)
            of_part.push_back(x[v]);
        if (part.closed)
            of_part = part.closed->positions(of_part);
        positions.insert(positions.end(), of_part.begin(), of_part.end());
    }
}

void ExportedMesh::append_values(const std::vector<std::vector<double>>& of_whole,
                                 std::vector<float>& values) const
{
    for (const Part& part : parts_)
        for (const std::vector<double>& quantity : of_whole)
            for (int side = 0; side < (part.closed ? 2 : 1); ++side)
                for (const int v : part.vertices)
                    values.push_back(float(quantity[size_t(v)]));
}

std::vector<std::optional<Vec3>> ExportedMesh::whole(const std::vector<std::vector<Vec3>>& meshes) const
{
    std::vector<std::optional<Vec3>> whole(size_t(vertex_count_), std::nullopt);
    for (size_t m = 0; m < parts_.size(); ++m) {
        const std::vector<Vec3> of_part =
            parts_[m].closed ? exports::ClosedSurface::middle(meshes[m]) : meshes[m];
        for (size_t k = 0; k < of_part.size(); ++k)
            whole[size_t(parts_[m].vertices[k])] = of_part[k];
    }
    return whole;
}

} // namespace toile::app
