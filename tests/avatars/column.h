#pragma once

#include <filesystem>

#include "avatars/model/skinned_avatar.h"

namespace toile::test {

using namespace avatars;

/// bending_column.gltf: a closed square column, 1 m high, of three rings of vertices with one texture seam
/// (15 vertices, 12 distinct positions, 20 triangles). Joint "base" at y = 0 carries the lowest ring, "tip"
/// at y = 0.5 the highest; the middle ring follows both with weights 0.5 and 0.4. Clip "bend" rotates the tip
/// by 90 degrees about Z in 1 s; "slide" moves the base 1 m along Z in 2 s.
inline std::filesystem::path column_file()
{
    return std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
}

inline std::vector<Vec3> posed(Avatar& avatar, const PoseAt& at, const Affine& placement = identity_affine())
{
    std::vector<Vec3> x(avatar.vertex_count());
    avatar.pose(at, placement, x);
    return x;
}

} // namespace toile::test
