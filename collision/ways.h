#pragma once

#include "core/backend/types.h"

namespace toile {

/// Where the vertices of a soup go, straight on and all in the same time [m]. A displacement common to all
/// (free fall) costs nothing. Borrowed fields of one item per vertex, or empty ones.
struct Ways {
    View<const Vec3> motion = {};  ///< the displacement that is expected; empty: none
    View<const double> slack = {}; ///< >= 0, and end this far beside; empty: 0
    View<const unsigned char> around =
        {}; ///< 1: only pairs with such a vertex are asked for; empty: all pairs
};

} // namespace toile
