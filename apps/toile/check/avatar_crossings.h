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
    std::vector<Site> clean; ///< crossings with clean triangles, by body, then by triangles
    int elsewhere = 0;       ///< number of crossings with triangles that are not clean
};

/// Finds crossings of cloth with avatars, counted separately for clean triangles of a body. Every realistic
/// moving body intersects itself, and cloth pinched there must cross one part or the other. A triangle is
/// clean unless it crosses another triangle of the body or lies inside another part of it
/// (PenetrationMeter::is_buried). Coincident vertices are merged.
/// @param avatars    at their current time
/// @param triangles  of the cloth
/// @param x          [vertices] of the cloth [m]
AvatarCrossings find_avatar_crossings(const ScenePenetration& avatars, View<const Triangle> triangles,
                                      View<const Vec3> x);

} // namespace toile::app
