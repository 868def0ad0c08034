#pragma once

#include "scenes/world.h"

namespace toile {

/// Pairs of triangles of all cloths that cross now, by exact predicates (find_crossings).
int crossing_count(const World& world);

} // namespace toile
