#pragma once

/// Rules that select near pairs, and functions that complete one. The same bodies on CPU and GPU.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "collision/self/facing.h"
#include "collision/self/near_pairs.h"
#include "collision/self/pair_geometry.h"

namespace toile::collision {

/// Numbers of two primitives.
struct Record {
    int first, second;
};

TOILE_HD inline bool share_vertex(const std::array<int, 4>& v, bool is_edge_edge)
{
    const int first = first_count(is_edge_edge);
    for (int a = 0; a < first; ++a)
        for (int b = first; b < 4; ++b)
            if (v[a] == v[b])
                return true;
    return false;
}

/// @param v      vertices of a pair
/// @param marks  [vertices]
TOILE_HD inline bool is_any_marked(const std::array<int, 4>& v, View<const unsigned char> marks)
{
    return marks[v[0]] != 0 || marks[v[1]] != 0 || marks[v[2]] != 0 || marks[v[3]] != 0;
}

TOILE_HD inline std::array<Vec3, 4> corners_of(const std::array<int, 4>& v, View<const Vec3> values)
{
    return {values[v[0]], values[v[1]], values[v[2]], values[v[3]]};
}

/// Vertices of a pair of primitives, given by their numbers.
struct PairCorners {
    View<const Triangle> triangles;
    View<const std::array<int, 2>> edges; ///< SurfaceEdges::vertex

    TOILE_HD std::array<int, 4> operator()(int first, int second, bool is_edge_edge) const
    {
        if (is_edge_edge) {
            const std::array<int, 2>&a = edges[first], &b = edges[second];
            return {a[0], a[1], b[0], b[1]};
        }
        const Triangle& t = triangles[second];
        return {first, t[0], t[1], t[2]};
    }
};

/// Final test of NearPairs::find, for pairs whose boxes overlap.
struct MayMeet {
    View<const Vec3> x; ///< [m]
    Trajectories trajectories;
    double margin;  ///< [m]
    bool is_moving; ///< MovingFrame::is_moving

    /// False only if the pair stays `margin` apart along the direction that separates it at x, or along that
    /// in which its sides pass each other. Trajectories are straight, so a separation at start and end holds
    /// throughout. The second direction sorts out most pairs of sides that move by several edges.
    TOILE_HD bool operator()(const std::array<int, 4>& v, bool is_edge_edge) const
    {
        const int first = first_count(is_edge_edge);
        const Slack slack = slack_of(v, first);
        const double apart = margin + slack.of_sides;
        const std::array<Vec3, 4> at = corners_of(v, x);
        const Vec3 difference = closest_difference(closest_weights(is_edge_edge, at), at);
        const double distance = difference.norm();
        if (distance <= apart)
            return true;
        if (!is_moving)
            return false;
        const std::array<Vec3, 4> motion = corners_of(v, trajectories.motion);
        const Vec3 n = difference / distance;
        return gap_at_end(n, at, motion, first) <= apart &&
               !pass_apart(difference, at, motion, first, margin + 2.0 * slack.largest);
    }

private:
    struct Slack {
        double of_sides; ///< [m] sum of the largest of each side
        double largest;  ///< [m] of all
    };

    /// Distance along n between the sides at the end [m]; negative if they overlap.
    TOILE_HD static double gap_at_end(const Vec3& n, const std::array<Vec3, 4>& at,
                                      const std::array<Vec3, 4>& motion, int first)
    {
        double ahead = std::numeric_limits<double>::max(), behind = -ahead;
        for (int k = 0; k < 4; ++k) {
            const double height = n.dot(at[k] - at[3] + motion[k]);
            if (k < first)
                ahead = std::min(ahead, height);
            else
                behind = std::max(behind, height);
        }
        return ahead - behind;
    }

    /// True if the sides stay `apart` along the difference that their closest points have where they pass
    /// each other by their mean motion. `apart` is that of the widest slack: a pair without it makes no term.
    TOILE_HD static bool pass_apart(const Vec3& difference, const std::array<Vec3, 4>& at,
                                    const std::array<Vec3, 4>& motion, int first, double apart)
    {
        Vec3 side[2] = {Vec3::Zero(), Vec3::Zero()};
        for (int k = 0; k < 4; ++k)
            side[k < first ? 0 : 1] += motion[k];
        const Vec3 relative = side[0] / first - side[1] / (4 - first);
        const double squared = relative.squaredNorm();
        if (!(squared > 0.0))
            return false;
        const double time = std::fmin(std::fmax(-difference.dot(relative) / squared, 0.0), 1.0);
        const Vec3 passing = difference + time * relative;
        const double distance = passing.norm();
        if (!(distance > apart))
            return false;
        const Vec3 n = passing / distance;
        const std::array<Vec3, 4> still{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
        return gap_at_end(n, at, still, first) > apart && gap_at_end(n, at, motion, first) > apart;
    }

    TOILE_HD Slack slack_of(const std::array<int, 4>& v, int first) const
    {
        double slack[2] = {0.0, 0.0};
        if (!trajectories.slack.empty())
            for (int k = 0; k < 4; ++k) {
                double& side = slack[k < first ? 0 : 1];
                side = std::max(side, trajectories.slack[v[k]]);
            }
        return {slack[0] + slack[1], std::max(slack[0], slack[1])};
    }
};

/// Pair at positions x [vertices x 3] [m].
TOILE_HD inline NearPair near_pair_at(View<const Triangle> triangles, const SurfaceEdgesView& edges,
                                      View<const Vec3> x, int first, int second, bool is_edge_edge)
{
    NearPair pair{};
    pair.first = first;
    pair.second = second;
    pair.is_edge_edge = is_edge_edge;
    pair.vertex = PairCorners{triangles, edges.vertex}(first, second, is_edge_edge);
    const std::array<Vec3, 4> corner = corners_of(pair.vertex, x);
    pair.weight = closest_weights(is_edge_edge, corner);
    const Vec3 difference = closest_difference(pair.weight, corner);
    pair.distance = difference.norm();
    pair.normal = separating_direction(is_edge_edge, corner, pair.weight, difference);
    pair.is_facing = is_edge_edge ? is_facing_edges(edges, triangles, x, pair, first, second)
                                  : is_facing_triangle(edges, triangles, x, pair, second);
    return pair;
}

/// Borrowed triangles and edges of a soup, from which pairs are completed.
struct SoupView {
    View<const Triangle> triangles;
    SurfaceEdgesView edges;

    /// The pair at other positions x [vertices x 3] [m].
    TOILE_HD NearPair at(View<const Vec3> x, const NearPair& pair) const
    {
        return near_pair_at(triangles, edges, x, pair.first, pair.second, pair.is_edge_edge);
    }
};

} // namespace toile::collision
