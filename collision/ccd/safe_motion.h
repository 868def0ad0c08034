#pragma once

/// Continuous collision detection of one pair of primitives: the largest safe part of its motion.

#include <array>
#include <cfloat>
#include <cmath>

#include "collision/self/pair_geometry.h"
#include "core/compute/types.h"

namespace toile::collision {

/// Fraction of the first gap at which a pair stops advancing [-]: fewer advances, but a motion that ends this
/// much early.
inline constexpr double kGapLeft = 0.05;

/// Gap of the corners along a direction, relative to the distance [-], below which other directions are
/// tried.
inline constexpr double kTrustedGap = 1.0 - 1e-6;

/// Maximum number of advances of one pair [-]. A straight approach takes one or two, 99 % of tumbling
/// primitives six.
inline constexpr int kMaxAdvances = 64;

/// Smallest distance of the first's corners from the second's along n [m]: a lower bound of the distance for
/// any |n| <= 1, because both primitives are convex.
TOILE_HD inline double gap_along(const Vec3& n, bool is_edge_edge, const std::array<Vec3, 4>& x)
{
    const int count = first_count(is_edge_edge);
    double gap = DBL_MAX;
    for (int a = 0; a < count; ++a)
        for (int b = count; b < 4; ++b)
            gap = std::fmin(gap, n.dot(x[a] - x[b]));
    return gap;
}

/// Separating direction, and its rotation with the features that define it.
struct MovingDirection {
    Vec3 n = Vec3::Zero();    ///< unit
    Vec3 rate = Vec3::Zero(); ///< [1 / fraction of the motion]
};

/// Smallest change of n per fraction of the motion that keeps it perpendicular to the active edges; zero if
/// they are nearly parallel.
TOILE_HD inline Vec3 rotation_rate(const Vec3& n, const ActiveEdges& edges, const std::array<Vec3, 4>& x,
                                   const std::array<Vec3, 4>& move)
{
    if (edges.count == 0)
        return Vec3::Zero();
    const Vec3 u = edges.of(0, x);
    const double uu = u.squaredNorm(), drift_u = -n.dot(edges.of(0, move));
    if (edges.count == 1)
        return (drift_u / uu) * u;
    const Vec3 v = edges.of(1, x);
    const double vv = v.squaredNorm(), uv = u.dot(v), drift_v = -n.dot(edges.of(1, move));
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > kParallelSine2 * uu * vv))
        return Vec3::Zero();
    return ((drift_u * vv - drift_v * uv) / determinant) * u +
           ((drift_v * uu - drift_u * uv) / determinant) * v;
}

/// Direction with the largest gap between the primitives, up to rounding. If they touch, two opposite
/// directions are equal; the one along which they part is taken.
TOILE_HD inline MovingDirection widest_direction(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                                 const std::array<Vec3, 4>& move)
{
    const std::array<double, 4> weight = closest_weights(is_edge_edge, x);
    const Vec3 difference = closest_difference(weight, x);
    Vec3 n = separating_direction(is_edge_edge, x, weight, difference);
    double gap = gap_along(n, is_edge_edge, x);
    const double distance = difference.norm();
    if (gap >= kTrustedGap * distance && gap > kNoDirection)
        return {n, rotation_rate(n, active_edges(is_edge_edge, weight), x, move)};

    // Rounding has removed most of the gap (tiny distance, nearly parallel edges): try other directions.
    const auto try_direction = [&](const Vec3& other) {
        const double other_gap = gap_along(other, is_edge_edge, x);
        const bool parts = gap_along(other, is_edge_edge, move) > gap_along(n, is_edge_edge, move);
        if (other_gap > gap || (other_gap == gap && parts)) {
            n = other;
            gap = other_gap;
        }
    };
    if (distance > 0.0)
        try_direction(difference / distance);
    const Vec3 across = direction_across(is_edge_edge, x, difference);
    if (!across.isZero(0.0))
        try_direction(across);
    try_direction(-n);
    return {n, rotation_rate(n, active_edges(is_edge_edge, weight), x, move)};
}

/// Fraction of the motion, at most `max_fraction`, for which all corner pairs stay `floor` [m] apart along
/// the rotating direction: the first root of
///   (n + s rate) . (x_a - x_b + s (move_a - move_b))  =  floor (1 + s |n . rate| + s^2 |rate|^2 / 2)
/// whose right side is at least floor |n + s rate|.
TOILE_HD inline double max_step_along(const MovingDirection& direction, bool is_edge_edge,
                                      const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& move,
                                      double floor, double max_fraction)
{
    const auto& [n, rate] = direction;
    const double widening = std::fabs(floor) * std::fabs(n.dot(rate));
    const double widening2 = 0.5 * std::fabs(floor) * rate.squaredNorm();
    const int count = first_count(is_edge_edge);
    double fraction = max_fraction;
    for (int a = 0; a < count; ++a)
        for (int b = count; b < 4; ++b) {
            const Vec3 gap = x[a] - x[b], speed = move[a] - move[b];
            const double c0 = n.dot(gap) - floor;
            const double c1 = n.dot(speed) + rate.dot(gap) - widening;
            const double c2 = rate.dot(speed) - widening2;
            if (c0 < 0.0)
                return 0.0;
            const double discriminant = c1 * c1 - 4.0 * c0 * c2;
            if ((c1 >= 0.0 && c2 >= 0.0) || discriminant < 0.0)
                continue;
            // Take the form of the first positive root that neither cancels nor divides 0 by 0.
            const double root = std::sqrt(discriminant);
            fraction = std::fmin(fraction, c1 < 0.0 ? 2.0 * c0 / (root - c1) : (root + c1) / (-2.0 * c2));
        }
    return fraction;
}

/// Largest fraction t in [0, 1], or slightly less, of the straight motion from x to x + move that keeps the
/// distance of the pair at or above `min_distance` [m]. A pair that begins nearer may not come nearer than it
/// began; a touching pair may only part.
///
/// Additive continuous collision detection [Li et al. 2021, Codimensional Incremental Potential Contact,
/// ACCD]: a sum of steps that are each safe. Deviation: theirs repeatedly divides the gap by the largest
/// relative speed. Here a step keeps one separating direction, fixed or rotating with the primitives. It
/// lasts until the first two corners come nearer than `min_distance` along that direction. Both primitives
/// are convex, so this gap is a lower bound of the distance. The fixed direction's step is never shorter than
/// theirs. The bound holds for any direction, so rounding in the closest points makes no step unsafe. Ends
/// when kGapLeft of the first gap is left, or after kMaxAdvances with the safe fraction so far.
TOILE_HD inline double max_safe_step(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                     const std::array<Vec3, 4>& move, double min_distance)
{
    // Rounding of the gaps, and of the vertices moved by the result.
    constexpr double kRoundings = 64.0;
    double largest = 0.0;
    for (int k = 0; k < 4; ++k)
        largest = std::fmax(largest, x[k].cwiseAbs().maxCoeff() + move[k].cwiseAbs().maxCoeff());
    const double slack = kRoundings * DBL_EPSILON * largest;

    // Lower bound of the gap: `min_distance`, or the first gap if that is smaller.
    std::array<Vec3, 4> now = x;
    MovingDirection direction = widest_direction(is_edge_edge, now, move);
    const double first_gap = gap_along(direction.n, is_edge_edge, now);
    const double floor = std::fmin(min_distance + slack, first_gap);

    double t = 0.0;
    for (int advance = 0; advance < kMaxAdvances; ++advance) {
        const double rest = 1.0 - t;
        double step = max_step_along({direction.n, Vec3::Zero()}, is_edge_edge, now, move, floor, rest);
        if (step >= rest)
            return 1.0;
        // A change by more than the direction's length leaves none; up to that, rounding is covered.
        const double rate_norm = direction.rate.norm();
        const double max_fraction = rate_norm * rest > 1.0 ? 1.0 / rate_norm : rest;
        step = std::fmax(step, max_step_along(direction, is_edge_edge, now, move, floor, max_fraction));
        if (step >= rest)
            return 1.0;
        t += step;
        for (int k = 0; k < 4; ++k)
            now[k] = x[k] + t * move[k];
        direction = widest_direction(is_edge_edge, now, move);
        if (!(gap_along(direction.n, is_edge_edge, now) - floor > kGapLeft * (first_gap - floor)))
            return t;
    }
    return t;
}

} // namespace toile::collision
