#include "export/gltf/glb_mesh.h"

#include <algorithm>

#include "export/corner_normals.h"

namespace toile::exports {

GlbMesh glb_mesh(const ObjMesh& faces, View<const Vec3> positions)
{
    // Corners share a vertex where they share a normal: position and texture coordinates are equal.
    const CornerNormals corners(faces);
    GlbMesh mesh;
    mesh.normals = corners.at(positions);
    mesh.vertices.resize(mesh.normals.size());
    const bool has_texture = !faces.polygon_uvs.empty();
    if (has_texture)
        mesh.texture.resize(mesh.normals.size());
    for (size_t p = 0; p < faces.polygons.size(); ++p)
        for (size_t k = 0; k < faces.polygons[p].size(); ++k) {
            const size_t index = size_t(corners.indices()[p][k]);
            mesh.vertices[index] = faces.polygons[p][k];
            if (has_texture) {
                const Vec2& uv = faces.texture_coordinates[size_t(faces.polygon_uvs[p][k])];
                mesh.texture[index] = Vec2(uv.x(), 1.0 - uv.y());
            }
        }

    // The format asks for unit normals also where faces have no area.
    for (Vec3& normal : mesh.normals)
        if (normal.isZero())
            normal = Vec3::UnitY();

    ObjMesh posed = faces;
    posed.positions.assign(positions.begin(), positions.end());
    for (size_t p = 0; p < faces.polygons.size(); ++p)
        for (const Triangle& triangle : posed.triangles_of(int(p)))
            for (const int corner : triangle)
                mesh.triangles.push_back(std::uint32_t(corners.indices()[p][size_t(corner)]));
    return mesh;
}

} // namespace toile::exports
