#pragma once

#include <optional>
#include <vector>

#include "collision/contact.h"

namespace toile {

/// Deepest that cloth is looked for inside a body [m]; deeper belongs to a scene that is set up wrongly.
inline constexpr double kMaxStartDepth = 0.1;

/// The place of the bodies' surfaces that a point has to leave, or stay away from.
struct BodyPlace {
    int body = -1;
    double signed_distance = 0.0; ///< [m] negative inside
    Vec3 normal = Vec3::UnitY();  ///< unit, out of the body
};

/// The body that p is deepest in, or else the nearest one within `reach` [m]; nothing where none is.
/// Open surfaces have no inside beyond their border.
std::optional<BodyPlace> nearest_body(const std::vector<ContactPartner>& bodies, const Vec3& p, double reach);

} // namespace toile
