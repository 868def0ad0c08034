#pragma once

#include <filesystem>

#include "avatars/model/skeletal_motion.h"

namespace toile::avatars {

/// Reads the skeleton and the clips of a file: .bvh, .fbx, .glb, .gltf, with or without a surface.
/// @throws InvalidInput in one line: file missing or unreadable, keys that can't be used
SkeletalMotion read_motion_file(const std::filesystem::path& file);

/// Clip of that name; without a name the longest, the first of equally long ones.
/// @throws InvalidInput for a file without clips, and an unknown name with the nearest one
const Clip& clip_named(const SkeletalMotion& motion, const std::string& name);

} // namespace toile::avatars
