#pragma once

#include <vector>

#include "collision/untangle/piercings.h"

namespace toile {

/// Vertices of the edges and triangles of piercings and, `rings` times over, of the triangles around them.
/// [vertices] nonzero for those.
std::vector<char> patch_around(const JoinedCloths& cloths, const std::vector<Piercing>& piercings, int rings);

/// Draws every vertex of a patch to the mean of its neighbours, sweep by sweep. The patch contracts towards
/// its rim as a smooth surface, whatever folds and knots it had: what local moves can't decide (which of two
/// linked flaps goes back) does not matter to it. Lengths are lost and have to be restored afterwards.
/// @param patch  [vertices] nonzero: moves
void iron(const JoinedCloths& cloths, const std::vector<char>& patch, int sweeps, View<Vec3> x);

} // namespace toile
