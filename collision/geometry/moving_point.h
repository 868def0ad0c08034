#pragma once

#include <algorithm>
#include <array>

#include "collision/bvh/box.h"

namespace toile::collision {

/// Single-precision slack of boxes, relative to the largest number in them [-]. It is several times the
/// rounding of a coordinate and of growing it (2^-24 each), so that no pair is missed.
inline constexpr double kFloatSlack = 1e-6;

/// Box around the straight trajectory of a vertex, in single precision relative to a moving centre. `slack`
/// is the distance by which the vertex may end beside the trajectory.
struct alignas(16) MovingPoint {
    std::array<float, 3> lower, upper; ///< [m]
    float slack;                       ///< [m]

    /// Largest absolute coordinate, slack added [m].
    TOILE_HD double largest() const
    {
        float max_extent = 0.0f;
        for (int k = 0; k < 3; ++k)
            max_extent = std::max(max_extent, std::max(-lower[k], upper[k]) + slack);
        return double(max_extent);
    }
};

/// Reference frame of moving points: the middle of all, moving with the mean motion. Equal motions thus
/// shrink no pair's distance.
struct MovingFrame {
    Vec3 center = Vec3::Zero(); ///< [m]
    Vec3 mean = Vec3::Zero();   ///< [m]
    bool is_moving = false;     ///< some vertex moves differently from the others

    /// @param motion  ignored if nothing moves
    TOILE_HD MovingPoint point(const Vec3& x, const Vec3& motion, double slack) const
    {
        const Vec3 from = x - center;
        Vec3 low = from, high = from;
        if (is_moving) {
            low = low.cwiseMin(from + motion - mean);
            high = high.cwiseMax(from + motion - mean);
        }
        MovingPoint point;
        for (int k = 0; k < 3; ++k) {
            point.lower[k] = float(low[k]);
            point.upper[k] = float(high[k]);
        }
        point.slack = float(slack);
        return point;
    }
};

/// Growth of boxes around moving points [m]: half the margin plus the slack of single precision.
/// @param largest  maximum of MovingPoint::largest() [m]
TOILE_HD inline float box_margin(double margin, double largest)
{
    return float(0.5 * margin + kFloatSlack * (largest + margin));
}

/// Box around the trajectories of points, grown on all sides by `margin` [m] and the largest slack.
template <typename... Point>
TOILE_HD Box box_around(float margin, const Point&... point)
{
    Box box;
    float slack = 0.0f;
    ((slack = std::max(slack, point.slack)), ...);
    const float grow = margin + slack;
    for (int k = 0; k < 3; ++k) {
        ((box.lower[k] = std::min(box.lower[k], point.lower[k])), ...);
        ((box.upper[k] = std::max(box.upper[k], point.upper[k])), ...);
        box.lower[k] -= grow;
        box.upper[k] += grow;
    }
    return box;
}

} // namespace toile::collision
