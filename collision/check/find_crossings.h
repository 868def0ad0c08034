#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Two triangles that have more in common than shared corners and edges.
struct Crossing {
    int a = -1, b = -1;        ///< triangles; of one soup a < b
    Vec3 point = Vec3::Zero(); ///< in both of them, to rounding [m]
};

/// All crossing pairs of triangles of a soup: they have a point in common beyond the corners and edges shared
/// by index (crosses.h defines this for each kind of pair). Exact for the double-precision coordinates.
/// Touching counts, so without crossings nothing passes through and nothing touches. Triangles without area
/// take part as segments and points; those with a corner that is not finite do not.
///
/// Independent of contact detection on purpose: this check certifies its results.
/// @param triangles  [triangles x 3] any list: open, closed, non-manifold
/// @param x          [vertices x 3] [m]
/// @return sorted by (a, b), the same for every number of threads
std::vector<Crossing> find_crossings(View<const Triangle> triangles, View<const Vec3> x);

/// All crossing pairs between two soups, which share no corner: all common points count.
/// @return sorted by (a, b); a is of the first soup, b of the second
std::vector<Crossing> find_crossings(View<const Triangle> triangles_a, View<const Vec3> x_a,
                                     View<const Triangle> triangles_b, View<const Vec3> x_b);

} // namespace toile::collision
