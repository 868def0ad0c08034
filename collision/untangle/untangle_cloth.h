#pragma once

#include "collision/untangle/body_clearing.h"
#include "collision/untangle/joined_cloths.h"
#include "collision/untangle/shape_keeper.h"

namespace toile {

/// Takes cloth that crosses cloth apart: contours are shortened while the cloth relaxes and stays out of the
/// bodies; where that gets stuck, ever larger patches are ironed.
/// @return true when no edge goes through a triangle any more
bool untangle(const JoinedCloths& cloths, const BodyClearing& clearing, ShapeKeeper& keeper, View<Vec3> x);

/// Restores the shape of cloth without crossings as far as none arises: relaxes, and takes back the moves of
/// vertices that would cross.
void relax_untangled(const JoinedCloths& cloths, const BodyClearing& clearing, const ShapeKeeper& keeper,
                     View<Vec3> x);

} // namespace toile
