#pragma once

/// Continuous collision of one pair of primitives: how far it may move before it comes too near.

#include <array>
#include <cfloat>
#include <cmath>

#include "collision/cloth/pair_geometry.h"
#include "core/backend/types.h"

namespace toile {

/// A pair stops advancing when this share of its first gap is left [-]: the price of fewer steps is a motion
/// that ends this much early.
inline constexpr double kGapLeft = 0.05;

/// Share of the distance that the corners must show along a direction [-] before another one is tried.
inline constexpr double kTrustedGap = 1.0 - 1e-6;

/// Advances of one pair [-], at most. Straight approach takes one or two, 99 % of tumbling primitives six.
inline constexpr int kMaxAdvances = 64;

/// How far the first's corners are ahead of the second's along n, at least: a lower bound of the distance for
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

/// A direction that separates and how it turns with the features it stands on.
struct MovingDirection {
    Vec3 n = Vec3::Zero();    ///< unit
    Vec3 rate = Vec3::Zero(); ///< [1 / share of the motion]
};

/// The least change of n per share of the motion that keeps it perpendicular to the active edges; zero
/// where they are nearly parallel.
TOILE_HD inline Vec3 turning_rate(const Vec3& n, const ActiveEdges& edges, const std::array<Vec3, 4>& x,
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

/// The direction along which the primitives are farthest apart, as well as it can be told; of two opposite
/// ones that are equally good (they touch) the one along which they part.
TOILE_HD inline MovingDirection widest_direction(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                                 const std::array<Vec3, 4>& move)
{
    const std::array<double, 4> weight = closest_weights(is_edge_edge, x);
    const Vec3 difference = closest_difference(weight, x);
    Vec3 n = separating_direction(is_edge_edge, x, weight, difference);
    double gap = gap_along(n, is_edge_edge, x);
    const double distance = difference.norm();
    if (gap >= kTrustedGap * distance && gap > kNoDirection)
        return {n, turning_rate(n, active_edges(is_edge_edge, weight), x, move)};

    // Rounding took most of it (tiny distance, nearly parallel edges): try the others there are.
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
    return {n, turning_rate(n, active_edges(is_edge_edge, weight), x, move)};
}

/// Share of the motion, at most `most`, for which all corner pairs stay `floor` [m] apart along the direction
/// as it turns: the first root of
///   (n + s rate) . (x_a - x_b + s (move_a - move_b))  =  floor (1 + s |n . rate| + s^2 |rate|^2 / 2)
/// whose right side is at least floor |n + s rate|.
TOILE_HD inline double share_along(const MovingDirection& direction, bool is_edge_edge,
                                   const std::array<Vec3, 4>& x, const std::array<Vec3, 4>& move,
                                   double floor, double most)
{
    const auto& [n, rate] = direction;
    const double widening = std::fabs(floor) * std::fabs(n.dot(rate));
    const double widening2 = 0.5 * std::fabs(floor) * rate.squaredNorm();
    const int count = first_count(is_edge_edge);
    double share = most;
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
            // Of the two forms of the first positive root the one that neither cancels nor divides 0 by 0.
            const double root = std::sqrt(discriminant);
            share = std::fmin(share, c1 < 0.0 ? 2.0 * c0 / (root - c1) : (root + c1) / (-2.0 * c2));
        }
    return share;
}

/// Largest share t in [0, 1], or a little less, of the straight motion from x to x + move for which the
/// distance of the pair stays at or above `least` [m] all the way. A pair that begins nearer than that may
/// not come nearer than it began; one that touches may only part.
///
/// Additive continuous collision [Li et al. 2021, Codimensional Incremental Potential Contact, ACCD]: add up
/// steps that are safe each. Deviation: theirs divides the gap by the greatest relative speed, over and
/// over; here a step holds on to one separating direction, fixed or turning with the primitives, and lasts
/// until the first two corners come nearer than `least` along it. Both primitives are convex, so that is a
/// lower bound of the distance; the fixed direction's step is never shorter than theirs, and the bound holds
/// for any direction, so rounding in the closest points makes no step unsafe.
/// Ends when kGapLeft of the first gap is left, or after kMaxAdvances with what is safe so far.
TOILE_HD inline double safe_share(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                  const std::array<Vec3, 4>& move, double least)
{
    // Rounding of the gaps and of whoever moves the vertices by the answer.
    constexpr double kRoundings = 64.0;
    double largest = 0.0;
    for (int k = 0; k < 4; ++k)
        largest = std::fmax(largest, x[k].cwiseAbs().maxCoeff() + move[k].cwiseAbs().maxCoeff());
    const double slack = kRoundings * DBL_EPSILON * largest;

    // What the gap may not fall below: `least`, or what it is where that is less.
    std::array<Vec3, 4> now = x;
    MovingDirection direction = widest_direction(is_edge_edge, now, move);
    const double first_gap = gap_along(direction.n, is_edge_edge, now);
    const double floor = std::fmin(least + slack, first_gap);

    double t = 0.0;
    for (int advance = 0; advance < kMaxAdvances; ++advance) {
        const double rest = 1.0 - t;
        double step = share_along({direction.n, Vec3::Zero()}, is_edge_edge, now, move, floor, rest);
        if (step >= rest)
            return 1.0;
        // A direction that turns by more than its own length is none; up to there rounding is covered.
        const double turning = direction.rate.norm();
        const double most = turning * rest > 1.0 ? 1.0 / turning : rest;
        step = std::fmax(step, share_along(direction, is_edge_edge, now, move, floor, most));
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

} // namespace toile
