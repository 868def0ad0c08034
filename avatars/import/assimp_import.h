#pragma once

#include <filesystem>

#include "avatars/model/appearance.h"
#include "avatars/model/skeletal_motion.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Reads a model through assimp: FBX, Collada and what else it knows; import_gltf() reads glTF. In the file's
/// units and axes. Every node becomes a joint, all meshes are merged, seams are welded, weights sum to 1. A
/// mesh without bones follows its node. Joints, bones and animation channels are matched by name, keys are
/// linear.
/// @throws InvalidInput in one line, see load_avatar().
RiggedModel import_rigged_model(const std::filesystem::path& file);

/// Reads the joints and clips of a file through assimp, whether it has a surface or not: BVH, FBX, Collada.
/// @throws InvalidInput in one line
SkeletalMotion import_skeletal_motion(const std::filesystem::path& file);

/// Reads the colours of a model through assimp, on the triangles of import_rigged_model(): diffuse or base
/// colours and images, in the file or beside it, and colours of vertices.
/// @throws InvalidInput in one line. Missing images are told in `left_out`.
Appearance import_model_appearance(const std::filesystem::path& file);

} // namespace toile::avatars
