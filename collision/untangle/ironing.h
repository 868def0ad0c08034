#pragma once

#include <vector>

#include "collision/untangle/joined_cloths.h"

namespace toile {

/// Grows a patch by the triangles that touch it, `rings` times. [vertices] nonzero for those in it.
void grow_patch(const JoinedCloths& cloths, int rings, std::vector<char>& patch);

/// Draws every vertex of a patch to the mean of its neighbours, sweep by sweep. The patch contracts towards
/// its rim as a smooth surface, whatever folds and knots it had: what local moves can't decide (which of two
/// linked flaps goes back) does not matter to it. Lengths are lost and have to be restored afterwards.
/// @param patch  [vertices] nonzero: moves
void iron(const JoinedCloths& cloths, const std::vector<char>& patch, int sweeps, View<Vec3> x);

} // namespace toile
