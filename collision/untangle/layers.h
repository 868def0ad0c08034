#pragma once

#include <vector>

#include "collision/contact.h"
#include "collision/untangle/joined_cloths.h"

namespace toile {

/// Brings cloth of higher layers outside cloth of lower ones that it crosses, layer by layer from the lowest:
/// the lower ones stand still and are to the next layer what a body is to all. Their outside is where the
/// bodies' normals point, or the winding of their triangles where no body is near. Cloths that don't cross
/// are left alone, however their layers stand.
/// @param x  [vertices] moved [m]
/// @return true when anything had to move
bool separate_layers(const JoinedCloths& cloths, const std::vector<ContactPartner>& bodies, View<Vec3> x);

/// Layers of the pieces with ties broken: of equal layers the piece that is further from the bodies on
/// average is the higher one, then the later one. [pieces] 0, 1, 2, ...
std::vector<int> layers_without_ties(const JoinedCloths& cloths, const std::vector<ContactPartner>& bodies);

} // namespace toile
