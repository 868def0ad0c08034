#pragma once

#include <algorithm>
#include <cmath>

#include "collision/cloth/near_pairs.h"
#include "collision/distance.h"
#include "collision/surface_edges.h"

namespace toile {

/// Weight of a corner [-] below which the closest point counts as off that corner: one that lies on an edge
/// up to rounding is on it for both triangles, so that one of them speaks for both.
inline constexpr double kOffCorner = 1e-9;

/// Greatest component [-] of the direction between two edges along a face beside one of them: where it is
/// larger the face comes nearer than its edge. Above 0 for edges that stand out on one side only.
inline constexpr double kIntoFace = 0.1;

/// Sine of the slope off an edge up to which the faces beside it are flat [-]: one degree.
inline constexpr double kFlat = 0.0175;

/// True when vertex v is the closest point of triangle t, or lies on the closest edge: none but `kept`
/// corners, given by vertex, carry weight.
template <typename IsKept>
TOILE_HD bool is_closest_on(View<const Triangle> triangles, View<const Vec3> x, const Vec3& p, int t,
                            const IsKept& is_kept)
{
    const Triangle& corner = triangles[t];
    const Vec3 weight = closest_on_triangle(p, x[corner[0]], x[corner[1]], x[corner[2]]).barycentric;
    for (int k = 0; k < 3; ++k)
        if (is_kept(corner[k]) != (weight[k] > kOffCorner))
            return false;
    return true;
}

/// Edge e stands out in `direction`, a unit vector: no face beside it lies ahead, and at least one falls
/// back. What meets a flat edge meets its faces, with vertices of its own.
TOILE_HD inline bool stands_out(const SurfaceEdgesView& edges, View<const Triangle> triangles,
                                View<const Vec3> x, int e, const Vec3& direction)
{
    const int low = edges.vertex[e][0], high = edges.vertex[e][1];
    const Vec3 along = (x[high] - x[low]).normalized();
    const View<const int> faces = edges.triangles.of(e);
    bool falls_back = faces.size() == 1;
    for (const int t : faces) {
        const Triangle& corner = triangles[t];
        const int apex = corner.sum() - low - high;
        const Vec3 arm = x[apex] - x[low];
        const Vec3 into_face = arm - along.dot(arm) * along;
        const double ahead = direction.dot(into_face), length = into_face.norm();
        if (!(length * length > kFlatTriangle2 * arm.squaredNorm()))
            continue; // collapsed: it lies along the edge, and only rounding would say where it goes
        if (ahead > kIntoFace * length)
            return false;
        falls_back = falls_back || ahead < -kFlat * length;
    }
    return falls_back;
}

/// NearPair::is_facing of a vertex and triangle t, whose pair is complete but for that.
TOILE_HD inline bool is_facing_triangle(const SurfaceEdgesView& edges, View<const Triangle> triangles,
                                        View<const Vec3> x, const NearPair& pair, int t)
{
    // The corners that the closest point lies on or between.
    const auto is_on = [&](int k) { return -pair.weight[1 + k] > kOffCorner; };
    const int count = int(is_on(0)) + int(is_on(1)) + int(is_on(2));
    const Vec3& p = x[pair.vertex[0]];
    if (count == 3)
        return true;

    if (count == 2) {
        const int k = !is_on(2) ? 0 : !is_on(0) ? 1 : 2;
        const int e = edges.triangle_edge[t][k];
        const std::array<int, 2>& end = edges.vertex[e];
        const View<const int> around = edges.triangles.of(e);
        return around[0] == t && std::all_of(around.begin(), around.end(), [&](int other) {
                   return is_closest_on(triangles, x, p, other,
                                        [&](int v) { return v == end[0] || v == end[1]; });
               });
    }

    const int corner = pair.vertex[is_on(0) ? 1 : is_on(1) ? 2 : 3];
    const View<const int> around = edges.corners_of_vertex.of(corner);
    return pair.vertex[0] < corner && around[0] / 3 == t &&
           std::all_of(around.begin(), around.end(), [&](int other) {
               return is_closest_on(triangles, x, p, other / 3, [&](int v) { return v == corner; });
           });
}

/// NearPair::is_facing of edges e and f, whose pair is complete but for that.
TOILE_HD inline bool is_facing_edges(const SurfaceEdgesView& edges, View<const Triangle> triangles,
                                     View<const Vec3> x, const NearPair& pair, int e, int f)
{
    for (const double weight : pair.weight)
        if (!(std::abs(weight) > kOffCorner))
            return false;
    const Vec3 a = x[pair.vertex[1]] - x[pair.vertex[0]];
    const Vec3 b = x[pair.vertex[3]] - x[pair.vertex[2]];
    if (!(a.cross(b).squaredNorm() > kParallelSine2 * a.squaredNorm() * b.squaredNorm()))
        return false;
    return stands_out(edges, triangles, x, e, -pair.normal) &&
           stands_out(edges, triangles, x, f, pair.normal);
}

} // namespace toile
