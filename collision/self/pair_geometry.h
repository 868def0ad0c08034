#pragma once

/// The closest points of a pair of primitives given by four points: vertex and triangle (p, a, b, c) or two
/// edges (a0, a1, b0, b1). "First" is the vertex or the edge a, "second" the triangle or the edge b.

#include <array>
#include <cmath>

#include "collision/geometry/distance.h"
#include "core/compute/types.h"

namespace toile::collision {

/// Distance below which the difference of two closest points has no reliable direction [m]. At this distance,
/// rounding of coordinates of some metres rotates it by 1e-3.
inline constexpr double kNoDirection = 1e-12;

/// Number of corners of the first primitive; the others of the four are the second's.
TOILE_HD inline int first_count(bool is_edge_edge) { return is_edge_edge ? 2 : 1; }

/// Signed weights, sum 0: sum_k weight_k x_k runs from the second's closest point to the first's.
TOILE_HD inline std::array<double, 4> closest_weights(bool is_edge_edge, const std::array<Vec3, 4>& x)
{
    if (is_edge_edge) {
        const ClosestOnSegments closest = closest_on_segments(x[0], x[1], x[2], x[3]);
        return {1.0 - closest.s, closest.s, closest.t - 1.0, -closest.t};
    }
    const Vec3 w = closest_on_triangle(x[0], x[1], x[2], x[3]).barycentric;
    return {1.0, -w[0], -w[1], -w[2]};
}

/// Difference from the second's closest point to the first's [m].
TOILE_HD inline Vec3 closest_difference(const std::array<double, 4>& weight, const std::array<Vec3, 4>& x)
{
    // Relative to one corner: the weights sum to 0 and large coordinates would cost digits.
    return weight[0] * (x[0] - x[3]) + weight[1] * (x[1] - x[3]) + weight[2] * (x[2] - x[3]);
}

/// Unit direction perpendicular to both primitives: the triangle's normal or the cross product of the edges.
/// Points to the side of `difference`; zero for collapsed or parallel primitives.
TOILE_HD inline Vec3 direction_across(bool is_edge_edge, const std::array<Vec3, 4>& x, const Vec3& difference)
{
    const Vec3 u = is_edge_edge ? Vec3(x[1] - x[0]) : Vec3(x[2] - x[1]);
    const Vec3 v = is_edge_edge ? Vec3(x[3] - x[2]) : Vec3(x[3] - x[1]);
    const Vec3 across = u.cross(v);
    const double length2 = across.squaredNorm();
    if (!(length2 > kFlatTriangle2 * u.squaredNorm() * v.squaredNorm()))
        return Vec3::Zero();
    return across * ((across.dot(difference) < 0.0 ? -1.0 : 1.0) / std::sqrt(length2));
}

/// A unit vector perpendicular to v; any unit vector if v is zero.
TOILE_HD inline Vec3 perpendicular(const Vec3& v)
{
    const Vec3 a = v.cwiseAbs();
    const Vec3 axis = a[0] <= a[1] && a[0] <= a[2] ? Vec3(1, 0, 0)
                      : a[1] <= a[2]               ? Vec3(0, 1, 0)
                                                   : Vec3(0, 0, 1);
    const Vec3 across = v.cross(axis);
    const double length = across.norm();
    return length > 0.0 ? Vec3(across / length) : axis;
}

/// Edges that span the features with the closest points: none for a corner, one for an edge, two inside a
/// triangle. Stored as corner numbers, so that they apply to positions and to motions.
struct ActiveEdges {
    int count = 0;
    int from[2] = {0, 0};
    int to[2] = {0, 0};

    TOILE_HD void add(int a, int b)
    {
        from[count] = a;
        to[count] = b;
        ++count;
    }
    TOILE_HD Vec3 of(int i, const std::array<Vec3, 4>& values) const
    {
        return values[to[i]] - values[from[i]];
    }
};

/// @param weight  from closest_weights: exactly 0 off the feature
TOILE_HD inline ActiveEdges active_edges(bool is_edge_edge, const std::array<double, 4>& weight)
{
    ActiveEdges edges;
    if (is_edge_edge) {
        for (int a = 0; a < 4; a += 2)
            if (weight[a] != 0.0 && weight[a + 1] != 0.0)
                edges.add(a, a + 1);
        return edges;
    }
    int first = 0;
    for (int k = 1; k < 4; ++k) {
        if (weight[k] == 0.0)
            continue;
        if (first > 0)
            edges.add(first, k);
        else
            first = k;
    }
    return edges;
}

/// Unit direction that separates the first from the second: along their difference. It is exactly
/// perpendicular to the active edges, unlike the difference of very near points. Touching primitives get
/// direction_across(), or if that is zero a direction perpendicular to an edge.
TOILE_HD inline Vec3 separating_direction(bool is_edge_edge, const std::array<Vec3, 4>& x,
                                          const std::array<double, 4>& weight, const Vec3& difference)
{
    const ActiveEdges edges = active_edges(is_edge_edge, weight);
    if (edges.count == 2) {
        const Vec3 u = edges.of(0, x), v = edges.of(1, x), across = u.cross(v);
        const double length2 = across.squaredNorm();
        if (length2 > kParallelSine2 * u.squaredNorm() * v.squaredNorm())
            return across * ((across.dot(difference) < 0.0 ? -1.0 : 1.0) / std::sqrt(length2));
    }
    const double distance = difference.norm();
    if (distance > kNoDirection) {
        Vec3 along = difference / distance;
        if (edges.count > 0) {
            const Vec3 edge = edges.of(0, x);
            along -= (along.dot(edge) / edge.squaredNorm()) * edge;
        }
        return along.normalized();
    }
    const Vec3 across = direction_across(is_edge_edge, x, difference);
    return across.isZero(0.0) ? perpendicular(is_edge_edge ? x[1] - x[0] : x[2] - x[1]) : across;
}

} // namespace toile::collision
