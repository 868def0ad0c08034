#pragma once

#include "core/compute/types.h"

namespace toile::collision {

/// Straight trajectories of a soup's vertices over one interval [m]. A displacement common to all (free fall)
/// costs nothing. Borrowed fields of one item per vertex, or empty ones.
struct Trajectories {
    View<const Vec3> motion = {};  ///< expected displacement; empty: none
    View<const double> slack = {}; ///< >= 0: distance by which the vertex may end beside it; empty: 0
    View<const unsigned char> selected =
        {}; ///< 1: only pairs with such a vertex are searched; empty: all pairs
};

} // namespace toile::collision
