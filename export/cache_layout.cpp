#include "export/cache_layout.h"

#include <algorithm>

namespace toile::exports {

ObjMesh faces_only(ObjMesh mesh)
{
    mesh.positions.clear();
    return mesh;
}

int CacheLayout::vertex_count() const
{
    int count = 0;
    for (const CacheMesh& mesh : meshes)
        count += mesh.vertex_count;
    return count;
}

int CacheLayout::attribute_count() const
{
    int count = 0;
    for (const CacheMesh& mesh : meshes)
        count += int(mesh.attributes.size()) * mesh.vertex_count;
    return count;
}

bool CacheLayout::has_attributes() const
{
    return std::any_of(meshes.begin(), meshes.end(), [](const CacheMesh& mesh) {
        return !mesh.attributes.empty() || !mesh.panels.of_face.empty();
    });
}

CacheLayout cache_layout(const ObjMesh& mesh, int frame_count)
{
    CacheLayout layout;
    layout.frame_count = frame_count;
    layout.meshes.push_back({"", "", int(mesh.positions.size()), faces_only(mesh)});
    return layout;
}

CacheLayout cache_layout(const TriangleMesh& mesh, int frame_count)
{
    return cache_layout(faces_of(mesh), frame_count);
}

} // namespace toile::exports
