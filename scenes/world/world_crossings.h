#pragma once

#include "scenes/world/world.h"

namespace toile::scenes {

/// Number of crossing pairs of triangles of all surfaces now, by exact predicates (find_crossings).
int crossing_count(const World& world);

} // namespace toile::scenes
