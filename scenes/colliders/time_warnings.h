#pragma once

#include <string>
#include <vector>

#include "scenes/colliders/collider.h"

namespace toile::scenes {

/// Warnings about bodies from caches that stand still for another time than the scene seems to mean: the
/// cache ends before the scene, the preroll does not, or there is nothing to roll.
/// @return one line each
std::vector<std::string> time_warnings(const Scene& scene, const std::vector<Collider>& colliders);

} // namespace toile::scenes
