#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "avatars/landmarks/body_segments.h"
#include "avatars/load_avatar.h"
#include "core/base/error.h"

namespace toile::test {

/// A body of the data folder; "mannequin" is the built-in one.
inline std::unique_ptr<avatars::Avatar> load_body(const std::string& name)
{
    avatars::AvatarSettings settings;
    if (name != "mannequin")
        settings.file = std::filesystem::path(TOILE_DATA_DIR) / name;
    return avatars::load_avatar(settings);
}

inline bool has_data() { return std::filesystem::is_directory(TOILE_DATA_DIR); }

inline TriangleMesh bind_pose(avatars::Avatar& avatar)
{
    TriangleMesh mesh{std::vector<Vec3>(size_t(avatar.vertex_count())), avatar.triangles()};
    avatar.pose({}, avatars::identity_affine(), mesh.positions);
    return mesh;
}

} // namespace toile::test
