#pragma once

#include <vector>

#include "apps/toile/check/penetration.h"
#include "collision/check/find_crossings.h"

namespace toile::app {

/// Crossings of cloth with a scene's mesh avatars. Shapes have no triangles; their check is penetration
/// depth.
struct AvatarCrossings {
    struct Site {
        int body;                     ///< index in ScenePenetration::bodies()
        collision::Crossing crossing; ///< a: triangle of the cloth, b: triangle of the body
    };
    std::vector<Site> clean;   ///< by body, then by triangles
    std::vector<Site> pinched; ///< where body parts leave no room for cloth, likewise
};

/// Finds crossings of cloth with avatars, those in pinches apart. Every realistic moving body intersects
/// itself, and cloth pinched there must cross one part or the other. A place is pinched if surface within 1
/// cm of it crosses other surface of the body, lies inside another part of it, or faces another part that is
/// nearer than the room that cloth needs (PenetrationMeter::is_pinched). A triangle of cloth with a corner in
/// a pinch reaches out of it by 2 cm at most. Coincident vertices are merged.
/// @param avatars    at their current time
/// @param triangles  of the cloth
/// @param x          [vertices] of the cloth [m]
AvatarCrossings find_avatar_crossings(const ScenePenetration& avatars, View<const Triangle> triangles,
                                      View<const Vec3> x);

} // namespace toile::app
