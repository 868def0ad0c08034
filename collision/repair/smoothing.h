#pragma once

#include <vector>

#include "collision/repair/joined_cloths.h"

namespace toile::collision {

/// Grows a patch by the triangles adjacent to it, `rings` times.
/// @param patch  [vertices] nonzero: in the patch
void grow_patch(const JoinedCloths& cloths, int rings, std::vector<char>& patch);

/// Moves every vertex of a patch towards the mean of its neighbours, sweep by sweep. The patch contracts
/// towards its rim as a smooth surface, whatever folds and knots it had. It thus resolves what local moves
/// cannot, such as which of two linked flaps goes back. Lengths are lost and have to be restored afterwards.
/// @param patch  [vertices] nonzero: moves
void smooth(const JoinedCloths& cloths, const std::vector<char>& patch, int sweeps, View<Vec3> x);

} // namespace toile::collision
