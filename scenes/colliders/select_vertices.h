#pragma once

#include <vector>

#include "scenes/colliders/collider.h"

namespace toile::scenes {

/// Selects vertices of a cloth by their start positions.
/// @param start      [vertices of the cloth] [m]
/// @param colliders  with the one that is named by a selection near an avatar
/// @return in ascending order, each once
std::vector<int> select_vertices(const scene::Selection& select, View<const Vec3> start,
                                 const std::vector<Collider>& colliders);

} // namespace toile::scenes
