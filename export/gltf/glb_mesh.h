#pragma once

#include <cstdint>
#include <vector>

#include "core/compute/types.h"
#include "export/cache_layout.h"

namespace toile::exports {

/// A mesh as graphics hardware draws it: triangles, with a vertex for each pair of position and texture
/// coordinates.
struct GlbMesh {
    std::vector<int> vertices;            ///< of the cache's mesh
    std::vector<Vec2> texture;            ///< of each, V down; empty: none
    std::vector<Vec3> normals;            ///< of each, unit length
    std::vector<std::uint32_t> triangles; ///< three indices each
};

/// @param positions  [vertices] which choose triangles of concave polygons, and give normals
GlbMesh glb_mesh(const ObjMesh& faces, View<const Vec3> positions);

} // namespace toile::exports
