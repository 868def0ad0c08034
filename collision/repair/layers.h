#pragma once

#include <vector>

#include "collision/contact/contact.h"
#include "collision/repair/joined_cloths.h"

namespace toile::collision {

/// Moves cloth of higher layers outside cloth of lower ones that it crosses, layer by layer from the lowest.
/// Lower layers stay fixed and act as bodies for the next layer. Their outside follows the bodies' normals,
/// or the winding of their triangles if no body is near. Cloths that do not cross are left alone, regardless
/// of their layers.
/// @param x  [vertices] moved [m]
/// @return true if anything had to move
bool separate_layers(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies, View<Vec3> x);

/// Layers of the pieces without ties: of equal layers the piece farther from the bodies on average is the
/// higher one, then the later one. [pieces] 0, 1, 2, ...
std::vector<int> layers_without_ties(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies);

} // namespace toile::collision
