#pragma once

#include <filesystem>

#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Distance below which two vertices of a file are coincident, over the diagonal of the mesh [-]. Single
/// precision files repeat seam positions exactly; real features are a thousand times farther apart.
inline constexpr double kSeamDistance = 1e-6;

/// Reads a model through assimp, in the file's units and axes. Every node becomes a joint, all meshes are
/// merged, seams are welded, weights sum to 1. A mesh without bones follows its node. Joints, bones and
/// animation channels are matched by name.
///
/// Cubic glTF keys are read as linear ones at the same times.
/// @throws InvalidInput in one line, see load_avatar().
RiggedModel import_rigged_model(const std::filesystem::path& file);

} // namespace toile::avatars
