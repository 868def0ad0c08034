#pragma once

#include <optional>
#include <vector>

#include "collision/contact/contact.h"

namespace toile::collision {

/// Maximum depth at which cloth is searched inside a body [m]; deeper cloth means a wrong scene.
inline constexpr double kMaxStartDepth = 0.1;

/// Nearest body surface of a point: the one to leave, or to keep away from.
struct BodyProximity {
    int body = -1;
    double signed_distance = 0.0; ///< [m] negative inside
    Vec3 normal = Vec3::UnitY();  ///< unit, out of the body
};

/// Body that p is deepest in, else the nearest one within `reach` [m]; nothing if there is none. Open
/// surfaces have no inside beyond their border.
std::optional<BodyProximity> nearest_body(const std::vector<ContactCollider>& bodies, const Vec3& p,
                                          double reach);

} // namespace toile::collision
