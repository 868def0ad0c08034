#pragma once

#include <vector>

#include "apps/toile/penetration.h"
#include "collision/crossings/find_crossings.h"

namespace toile {

/// Where cloth crosses the surface of a scene's mesh avatars. Shapes have no triangles; depth covers them.
struct AvatarCrossings {
    struct Place {
        int body;          ///< index in ScenePenetration::bodies()
        Crossing crossing; ///< a: triangle of the cloth, b: triangle of the body
    };
    std::vector<Place> clean; ///< by body, then by triangles
    int elsewhere = 0;        ///< number of crossings with triangles of a body that are not clean
};

/// Every real body in motion intersects itself, and cloth pinched there crosses one part or the other
/// whatever it does. So the body's triangles are told apart: one is clean unless it crosses another triangle
/// of the body, or lies inside another part of it (PenetrationMeter::is_buried). Vertices at one place are
/// one.
/// @param avatars    at the time shown
/// @param triangles  of the cloth
/// @param x          [vertices] of the cloth [m]
AvatarCrossings find_avatar_crossings(const ScenePenetration& avatars, View<const Triangle> triangles,
                                      View<const Vec3> x);

} // namespace toile
