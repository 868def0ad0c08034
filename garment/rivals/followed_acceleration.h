#pragma once

#include "core/backend/types.h"

namespace toile {

/// The part of the acceleration that a vertex has followed: along a, between nothing and all of it.
/// [Chen et al. 2024, section 3.7]
/// @param last  acceleration of the vertex in the step before [m/s^2]
TOILE_HD inline Vec3 followed(const Vec3& acceleration, const Vec3& last)
{
    const double square = acceleration.squaredNorm(), along = last.dot(acceleration);
    if (!(square > 0.0) || !(along > 0.0))
        return Vec3::Zero();
    return (along < square ? along / square : 1.0) * acceleration;
}

} // namespace toile
