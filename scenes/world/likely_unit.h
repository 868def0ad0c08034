#pragma once

#include <string>
#include <vector>

#include "scenes/colliders/collider.h"
#include "scenes/world/scene_cloth.h"

namespace toile::scenes {

/// Warnings about cloths, avatars and solids of files whose size does not fit the bodies of the scene, or
/// what they are at all, with the unit that would fit.
/// @return one line each
std::vector<std::string> unit_warnings(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                       const std::vector<Collider>& colliders);

} // namespace toile::scenes
