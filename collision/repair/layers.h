#pragma once

#include <vector>

#include "collision/contact/contact.h"
#include "collision/repair/joined_cloths.h"
#include "collision/repair/repair_progress.h"

namespace toile::collision {

/// Piece of cloth between a body and cloth of a lower layer, which it should be outside of.
struct UnderLayer {
    int piece;
    int vertex;   ///< deepest of it
    int lower;    ///< vertex of the lower layer's cloth
    double depth; ///< [m]
};

/// Pieces most of which lie under a lower layer where both are near a body.
std::vector<UnderLayer> find_under_layers(const JoinedCloths& cloths,
                                          const std::vector<ContactCollider>& bodies, View<const Vec3> x);

/// Moves cloth of higher layers outside cloth of lower ones that it crosses, touches or lies under, layer by
/// layer from the lowest. Lower layers stay fixed and act as bodies for the next layer. Their outside follows
/// the bodies' normals, or the winding of their triangles if no body is near. Other cloths are left alone,
/// regardless of their layers.
/// @param x  [vertices] moved [m]
/// @return true if anything had to move
bool separate_layers(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies, View<Vec3> x,
                     const RepairProgress& progress);

/// Layers of the pieces without ties: of equal layers the piece farther from the bodies on average is the
/// higher one, then the later one. [pieces] 0, 1, 2, ...
std::vector<int> layers_without_ties(const JoinedCloths& cloths, const std::vector<ContactCollider>& bodies);

} // namespace toile::collision
