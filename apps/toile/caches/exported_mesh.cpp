#include "apps/toile/caches/exported_mesh.h"

#include <numeric>
#include <utility>

#include "export/mesh/mesh_part.h"

namespace toile::app {

ExportedMesh::ExportedMesh(const exports::CacheMesh& whole, bool weld, const std::vector<double>& thickness)
    : vertex_count_(whole.vertex_count)
{
    const std::vector<exports::MeshPart> groups =
        weld ? std::vector<exports::MeshPart>{} : exports::parts_of(whole.faces);
    if (groups.size() > 1) {
        for (const exports::MeshPart& group : groups)
            add_part({group.name, whole.name, int(group.vertices.size()), group.faces}, group.vertices,
                     thickness);
        return;
    }
    std::vector<int> all(size_t(whole.vertex_count));
    std::iota(all.begin(), all.end(), 0);
    add_part(whole, std::move(all), thickness);
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
