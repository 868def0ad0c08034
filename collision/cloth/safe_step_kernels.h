#pragma once

/// SafeStep vertex by vertex and pair by pair. The same bodies on CPU and GPU.

#include <algorithm>
#include <array>

#include "collision/cloth/pair_rules.h"
#include "collision/cloth/pair_watch.h"
#include "collision/cloth/safe_motion.h"

namespace toile {

/// How much farther than it has strayed a vertex may go on before pairs are looked for again [-].
inline constexpr double kStrayMore = 0.5;

/// How near the sides of a pair may come.
struct LeastGap {
    double least;     ///< [m] SafeStep::Settings::least_gap
    double share;     ///< [-] least_share
    double thickness; ///< [m]

    /// [m] Of two layers that lie on each other a tenth of their distance is left; far ones may come that
    /// near too.
    TOILE_HD double of(const NearPair& pair) const
    {
        return std::max(least, share * std::min(pair.distance, thickness));
    }
    TOILE_HD double most() const { return std::max(least, share * thickness); } ///< of any pair [m]
};

/// True where the direction that separates the pair at first shows that it may go all of its way.
TOILE_HD inline bool stays_apart(const NearPair& pair, const std::array<Vec3, 4>& x,
                                 const std::array<Vec3, 4>& move, double least)
{
    std::array<Vec3, 4> end;
    for (int k = 0; k < 4; ++k)
        end[k] = x[k] + move[k];
    return pair.distance >= least && gap_along(pair.normal, pair.is_edge_edge, end) >= least;
}

/// The share of its vertices' ways that a pair allows [-].
struct PairShare {
    View<const Vec3> base, motion; ///< [vertices] [m]
    LeastGap gap;

    TOILE_HD double operator()(const NearPair& pair) const
    {
        const std::array<Vec3, 4> x = corners_of(pair.vertex, base), move = corners_of(pair.vertex, motion);
        if (move[1] == move[0] && move[2] == move[0] && move[3] == move[0])
            return 1.0; // whatever rounding would say: there is nothing left to bring back
        const double least = gap.of(pair);
        return stays_apart(pair, x, move, least) ? 1.0 : safe_share(pair.is_edge_edge, x, move, least);
    }
};

/// What lists of pairs are complete for: ways that end within a sphere, a vertex each.
struct KnownWays {
    View<Vec3> motion;   ///< [vertices] [m]
    View<double> radius; ///< [vertices] around it [m]

    TOILE_HD bool hold(int v, const Vec3& way) const
    {
        return !((way - motion[v]).squaredNorm() > radius[v] * radius[v]);
    }

    /// Lists that are about to be complete for more: for a way that has strayed from the one that was asked
    /// for, and for half as much again.
    TOILE_HD void widen(int v, const Vec3& way, double strayed, double slack) const
    {
        motion[v] = way;
        radius[v] = std::max(slack, kStrayMore * strayed);
    }
};

/// From the pose x to the expected one, and slack beside it: KnownWays of a list that was found for these.
struct KnowExpected {
    View<const Vec3> x, expected; ///< [vertices] [m]
    View<const double> slack;     ///< [vertices] [m]
    KnownWays known;              ///< out

    TOILE_HD void operator()(int v) const
    {
        known.motion[v] = expected[v] - x[v];
        known.radius[v] = slack[v];
    }
};

/// The way of vertex v to x, marked where the lists don't hold for it; a term of how many are.
struct CountStrays {
    View<const Vec3> base, x; ///< [vertices] [m]
    KnownWays known;
    View<Vec3> way;            ///< [vertices] out [m]
    View<unsigned char> marks; ///< [vertices] out

    TOILE_HD int operator()(int v) const
    {
        way[v] = x[v] - base[v];
        const bool strays = !known.hold(v, way[v]);
        marks[v] = (unsigned char)(strays ? 1 : 0);
        return strays ? 1 : 0;
    }
};

/// Widens what is known of marked vertices to where they want to go.
struct KnowStrays {
    View<const unsigned char> marks; ///< [vertices]
    View<const Vec3> way;            ///< [vertices] [m]
    View<const double> slack;        ///< [vertices] [m]
    KnownWays known;                 ///< changed

    TOILE_HD void operator()(int v) const
    {
        if (marks[v] != 0)
            known.widen(v, way[v], 0.0, slack[v]);
    }
};

/// Where a vertex goes now, marked, and widens what is known of it where the lists don't hold for that; a
/// term of how many vertices these are.
struct KnowChanged {
    View<const ChangedWay> changed;
    View<const double> slack;     ///< [vertices] [m]
    KnownWays known;              ///< changed
    View<Vec3> way;               ///< [vertices] in, out [m]
    View<unsigned char> is_stale; ///< [vertices] in, out
    View<unsigned char> strays;   ///< [vertices] in, out

    TOILE_HD int operator()(int i) const
    {
        const ChangedWay& now = changed[i];
        way[now.vertex] = now.way;
        is_stale[now.vertex] = 1;
        if (known.hold(now.vertex, now.way))
            return 0;
        known.widen(now.vertex, now.way, now.strayed, slack[now.vertex]);
        strays[now.vertex] = 1;
        return 1;
    }
};

/// Flags a pair that is in its own way where it has a stale vertex or is not among the `known` first; a term
/// of how many are.
struct CountInTheWay {
    View<const NearPair> pairs;
    PairShare share;
    View<const unsigned char> is_stale; ///< [vertices]
    int known;
    View<unsigned char> flags; ///< [pairs] in, out

    TOILE_HD int operator()(int i) const
    {
        if (i >= known || is_any_marked(pairs[i].vertex, is_stale))
            flags[i] = (unsigned char)(share(pairs[i]) < 1.0 ? 1 : 0);
        return flags[i];
    }
};

/// The k-th pair that is in its own way.
struct ReportInTheWay {
    View<const NearPair> pairs;
    PairShare share;
    View<const int> places;    ///< of the flagged pairs
    View<BlockedPair> blocked; ///< out
    TOILE_HD void operator()(int k) const
    {
        const NearPair& pair = pairs[places[k]];
        blocked[k] = {pair, share(pair)};
    }
};

} // namespace toile
