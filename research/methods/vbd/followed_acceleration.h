#pragma once

#include "core/compute/types.h"

namespace toile::research {

/// Part of the acceleration a that a vertex has followed: the component of `last` along a, clamped between
/// zero and a. [Chen et al. 2024, section 3.7]
/// @param last  acceleration of the vertex in the previous step [m/s^2]
TOILE_HD inline Vec3 followed(const Vec3& acceleration, const Vec3& last)
{
    const double square = acceleration.squaredNorm(), along = last.dot(acceleration);
    if (!(square > 0.0) || !(along > 0.0))
        return Vec3::Zero();
    return (along < square ? along / square : 1.0) * acceleration;
}

} // namespace toile::research
