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
inline constexpr double kTrustedGap = 0.99;

/// Advances of one pair [-], at most. Straight approach takes one or two, tumbling triangles up to ten.
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

/// Unit direction along which the primitives are farthest apart, as well as it can be told; of two opposite
/// ones that are equally good (they touch) the one along which they part.
TOILE_HD inline Vec3 widest_direction(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                      const std::array<Vec3, 4>& move)
{
    const Vec3 difference = closest_difference(closest_weights(is_edge_edge, x), x);
    const Vec3 along = separating_direction(is_edge_edge, x, difference);
    const double gap = gap_along(along, is_edge_edge, x);
    if (gap >= kTrustedGap * difference.norm() && gap > kNoDirection)
        return along;

    // The difference of very near points is mostly rounding: the direction across both may do better.
    const Vec3 across = direction_across(is_edge_edge, x, difference);
    const Vec3 n = gap_along(across, is_edge_edge, x) > gap ? across : along;
    const double back = gap_along(-n, is_edge_edge, x), ahead = gap_along(n, is_edge_edge, x);
    const bool parts_back = gap_along(-n, is_edge_edge, move) > gap_along(n, is_edge_edge, move);
    return back > ahead || (back == ahead && parts_back) ? Vec3(-n) : n;
}

/// Time from t on, in [t, 1], until which every corner pair stays `floor` [m] apart along n.
TOILE_HD inline double time_along(const Vec3& n, bool is_edge_edge, const std::array<Vec3, 4>& x,
                                  const std::array<Vec3, 4>& move, double floor, double t)
{
    const int count = first_count(is_edge_edge);
    double end = 1.0;
    for (int a = 0; a < count; ++a)
        for (int b = count; b < 4; ++b) {
            const double speed = n.dot(move[a] - move[b]);
            const double gap = n.dot(x[a] - x[b]) - floor;
            // Linear in time: it has to hold at t and at the end.
            if (gap + t * speed < 0.0)
                return t;
            if (speed < 0.0)
                end = std::fmin(end, gap / -speed);
        }
    return std::fmax(end, t);
}

/// Largest share t in [0, 1], or a little less, of the straight motion from x to x + move for which the
/// distance of the pair stays at or above `least` [m] all the way. A pair that begins nearer than that may
/// not come nearer than it began; one that touches may only part.
///
/// Additive continuous collision [Li et al. 2021, Codimensional Incremental Potential Contact, alg. 1]: add
/// up steps that are safe each. Deviation: theirs divides the gap by the greatest relative speed; here a step
/// holds on to one separating direction n and lasts until the first two corners come nearer than `least`
/// along it. Both primitives are convex, so that is a lower bound of the distance, exact in t, and never a
/// shorter step; its proof needs no exact n. Ends when kGapLeft of the first gap is left.
TOILE_HD inline double safe_share(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                  const std::array<Vec3, 4>& move, double least)
{
    // Rounding of the gaps below and of whoever moves the vertices by the answer.
    constexpr double kRoundings = 32.0;
    double largest = 0.0;
    for (int k = 0; k < 4; ++k)
        largest = std::fmax(largest, x[k].cwiseAbs().maxCoeff() + move[k].cwiseAbs().maxCoeff());
    const double slack = kRoundings * DBL_EPSILON * largest;

    // What the gap may not fall below: `least`, or what it is where that is less.
    std::array<Vec3, 4> now = x;
    Vec3 n = widest_direction(is_edge_edge, now, move);
    const double first_gap = gap_along(n, is_edge_edge, now);
    const double floor = std::fmin(least + slack, first_gap);

    double t = 0.0;
    for (int advance = 0; advance < kMaxAdvances; ++advance) {
        t = time_along(n, is_edge_edge, x, move, floor, t);
        if (t >= 1.0)
            return 1.0;
        for (int k = 0; k < 4; ++k)
            now[k] = x[k] + t * move[k];
        n = widest_direction(is_edge_edge, now, move);
        if (!(gap_along(n, is_edge_edge, now) - floor > kGapLeft * (first_gap - floor)))
            return t;
    }
    return t;
}

} // namespace toile
