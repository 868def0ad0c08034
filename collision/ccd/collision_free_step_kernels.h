#pragma once

/// Kernels of CollisionFreeStep, per vertex and per pair. The same bodies on CPU and GPU.

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/ccd/ccd_query.h"
#include "collision/ccd/safe_motion.h"
#include "collision/self/pair_rules.h"

namespace toile::collision {

/// Further deviation of a vertex, relative to its deviation so far [-], before pairs are searched for again.
inline constexpr double kDeviationMargin = 0.5;

/// Largest such deviation [m]. Pairs grow by the cube of it: cloth that a jump has pulled through a room
/// would have millions of them.
inline constexpr double kMaxDeviationMargin = 0.01;

/// Minimum gap of a pair.
struct MinGap {
    double min_gap;   ///< [m] CollisionFreeStep::Settings::min_gap
    double fraction;  ///< [-] min_gap_fraction
    double thickness; ///< [m]

    /// Minimum gap of a pair [m]. Two layers in contact keep `fraction` of their distance; distant pairs may
    /// come equally near.
    TOILE_HD double of(const NearPair& pair) const
    {
        return std::max(min_gap, fraction * std::min(pair.distance, thickness));
    }
    TOILE_HD double largest() const { return std::max(min_gap, fraction * thickness); } ///< of any pair [m]
};

/// True if the initial separating direction of the pair proves that its displacements are free.
TOILE_HD inline bool stays_apart(const NearPair& pair, const std::array<Vec3, 4>& x,
                                 const std::array<Vec3, 4>& move, double min_gap)
{
    std::array<Vec3, 4> end;
    for (int k = 0; k < 4; ++k)
        end[k] = x[k] + move[k];
    return pair.distance >= min_gap && gap_along(pair.normal, pair.is_edge_edge, end) >= min_gap;
}

/// Fraction of its vertices' displacements that a pair allows [-].
struct PairSafeFraction {
    View<const Vec3> base, motion; ///< [vertices] [m]
    MinGap gap;

    TOILE_HD double operator()(const NearPair& pair) const
    {
        const std::array<Vec3, 4> x = corners_of(pair.vertex, base), move = corners_of(pair.vertex, motion);
        if (move[1] == move[0] && move[2] == move[0] && move[3] == move[0])
            return 1.0; // regardless of rounding: there is nothing left to shorten
        const double min_gap = gap.of(pair);
        return stays_apart(pair, x, move, min_gap) ? 1.0 : max_safe_step(pair.is_edge_edge, x, move, min_gap);
    }
};

/// Displacement of vertex v.
struct DisplacementTo {
    View<const Vec3> x, end; ///< [vertices] [m]
    View<Vec3> motion;       ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const { motion[v] = end[v] - x[v]; }
};

/// Trajectories for which lists of pairs are complete: one sphere of end positions per vertex.
struct KnownTrajectories {
    View<Vec3> motion;   ///< [vertices] [m]
    View<double> radius; ///< [vertices] around it [m]

    TOILE_HD bool cover(int v, const Vec3& displacement) const
    {
        return !((displacement - motion[v]).squaredNorm() > radius[v] * radius[v]);
    }

    /// Recentres the sphere of v at a displacement, before a search makes the lists complete for it. The
    /// radius is kDeviationMargin of its deviation from the requested displacement, at most
    /// kMaxDeviationMargin, and at least the slack.
    TOILE_HD void widen(int v, const Vec3& displacement, double deviation, double slack) const
    {
        motion[v] = displacement;
        radius[v] = std::max(slack, std::fmin(kDeviationMargin * deviation, kMaxDeviationMargin));
    }
};

/// Makes the trajectory of v unknown.
struct ForgetKnown {
    KnownTrajectories known; ///< out
    TOILE_HD void operator()(int v) const
    {
        known.motion[v] = Vec3::Constant(1e100); // far from any displacement, and its square is finite
        known.radius[v] = 0.0;
    }
};

/// Sets the KnownTrajectories of a list that was found for displacements from x to `expected`, with slack.
struct RecordExpected {
    View<const Vec3> x, expected; ///< [vertices] [m]
    View<const double> slack;     ///< [vertices] [m]
    KnownTrajectories known;      ///< out

    TOILE_HD void operator()(int v) const
    {
        known.motion[v] = expected[v] - x[v];
        known.radius[v] = slack[v];
    }
};

/// When a search for the pairs of marked vertices finds those of all vertices anew, in place of all that were
/// found since CollisionFreeStep::begin(). Where many are marked, or have been so often that most pairs are
/// repeated, trajectories would grow wide, with pairs by the cube of their width.
/// @param marked, vertices     numbers of vertices
/// @param pairs, of_complete  pairs now, and after the last such search
inline bool is_search_complete(int marked, int vertices, int pairs, int of_complete)
{
    constexpr double kMaxMarked = 0.1, kMaxGrowth = 3.0;
    return marked > kMaxMarked * vertices || pairs > kMaxGrowth * std::max(of_complete, vertices);
}

/// Makes the present displacement of vertex v the known one, and marks it. It is that of marked vertices
/// already.
struct RecentreKnown {
    View<const Vec3> displacement; ///< [vertices] [m]
    View<const double> slack;      ///< [vertices] [m]
    KnownTrajectories known;       ///< out
    View<unsigned char> marks;     ///< [vertices] changed

    TOILE_HD void operator()(int v) const
    {
        if (marks[v] != 0)
            return;
        known.motion[v] = displacement[v];
        known.radius[v] = slack[v];
        marks[v] = 1;
    }
};

/// Computes the displacement of vertex v to x and marks it if the lists do not cover it. Returns 1 for a
/// marked vertex, to count them.
struct MarkOutOfBounds {
    View<const Vec3> base, x; ///< [vertices] [m]
    KnownTrajectories known;
    View<Vec3> displacement;   ///< [vertices] out [m]
    View<unsigned char> marks; ///< [vertices] out

    TOILE_HD int operator()(int v) const
    {
        displacement[v] = x[v] - base[v];
        const bool out_of_bounds = !known.cover(v, displacement[v]);
        marks[v] = (unsigned char)(out_of_bounds ? 1 : 0);
        return out_of_bounds ? 1 : 0;
    }
};

/// Widens the KnownTrajectories of marked vertices to their displacements.
struct WidenKnown {
    View<const unsigned char> marks; ///< [vertices]
    View<const Vec3> displacement;   ///< [vertices] [m]
    View<const double> slack;        ///< [vertices] [m]
    KnownTrajectories known;         ///< changed

    TOILE_HD void operator()(int v) const
    {
        if (marks[v] != 0)
            known.widen(v, displacement[v], 0.0, slack[v]);
    }
};

/// Stores a changed trajectory and marks its vertex as stale. If the lists do not cover it, marks the vertex
/// as out of bounds and widens its KnownTrajectories. Returns 1 for an out-of-bounds vertex, to count them.
struct RecordChanged {
    View<const ChangedTrajectory> changed;
    View<const double> slack;          ///< [vertices] [m]
    KnownTrajectories known;           ///< changed
    View<Vec3> displacement;           ///< [vertices] in, out [m]
    View<unsigned char> is_stale;      ///< [vertices] in, out
    View<unsigned char> out_of_bounds; ///< [vertices] in, out

    TOILE_HD int operator()(int i) const
    {
        const ChangedTrajectory& now = changed[i];
        displacement[now.vertex] = now.displacement;
        is_stale[now.vertex] = 1;
        if (known.cover(now.vertex, now.displacement))
            return 0;
        known.widen(now.vertex, now.displacement, now.deviation, slack[now.vertex]);
        out_of_bounds[now.vertex] = 1;
        return 1;
    }
};

/// Updates the flag of a pair that has a stale vertex or is not among the first `known`. Returns 1 for a
/// blocked pair, to count them.
struct CountBlocked {
    View<const NearPair> pairs;
    PairSafeFraction fraction;
    View<const unsigned char> is_stale; ///< [vertices]
    int known;
    View<unsigned char> flags; ///< [pairs] in, out

    TOILE_HD int operator()(int i) const
    {
        if (i >= known || is_any_marked(pairs[i].vertex, is_stale))
            flags[i] = (unsigned char)(fraction(pairs[i]) < 1.0 ? 1 : 0);
        return flags[i];
    }
};

/// Writes the k-th blocked pair.
struct ReportBlocked {
    View<const NearPair> pairs;
    PairSafeFraction fraction;
    View<const int> indices;   ///< of the flagged pairs
    View<BlockedPair> blocked; ///< out
    TOILE_HD void operator()(int k) const
    {
        const NearPair& pair = pairs[indices[k]];
        blocked[k] = {pair, fraction(pair)};
    }
};

} // namespace toile::collision
