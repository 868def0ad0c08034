#pragma once

#include "collision/repair/body_clearing.h"
#include "collision/repair/joined_cloths.h"
#include "collision/repair/shape_keeper.h"

namespace toile::collision {

/// Untangles cloth that crosses cloth: shortens contours while the cloth relaxes and stays out of the bodies.
/// When this stalls, it smooths ever larger patches.
/// @return true if no edge goes through a triangle any more
bool untangle(const JoinedCloths& cloths, const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x);

/// Restores the shape of untangled cloth without creating crossings: relaxes, and reverts the moves of
/// vertices that would cross.
void relax_untangled(const JoinedCloths& cloths, const BodyClearing& clearing, const ShapeKeeper& keeper,
                     View<Vec3> x, const RepairProgress& progress);

/// Moves cloth off surfaces of bodies that it crosses between its samples: out to the gap, then by small
/// pushes. Reverts what would cross cloth.
void clear_crossings(const JoinedCloths& cloths, const BodyClearing& clearing, View<Vec3> x);

} // namespace toile::collision
