#pragma once

#include <algorithm>
#include <cmath>

#include "collision/geometry/distance.h"
#include "collision/geometry/surface_edges.h"
#include "collision/self/near_pairs.h"

namespace toile::collision {

/// Weight of a corner [-] below which the closest point counts as off that corner. A point on an edge up to
/// rounding then lies on it for both triangles, and one of them represents both.
inline constexpr double kOffCorner = 1e-9;

/// Maximum component [-] of the direction between two edges along a face adjacent to one of them. Beyond it
/// the face is nearer than its edge. Above 0 for edges that stand out on one side only.
inline constexpr double kIntoFace = 0.1;

/// Sine of the slope off an edge up to which its faces count as flat [-]: one degree.
inline constexpr double kFlat = 0.0175;

/// True if exactly the corners whose vertices are kept have weight in the point of triangle t closest to p.
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

/// True if edge e stands out in `direction`, a unit vector: no adjacent face lies ahead, and at least one
/// falls back or e is a border. Contact with a flat edge is covered by vertex-triangle pairs of its faces.
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
            continue; // collapsed onto the edge: its direction is rounding
        if (ahead > kIntoFace * length)
            return false;
        falls_back = falls_back || ahead < -kFlat * length;
    }
    return falls_back;
}

/// NearPair::is_facing of a vertex and triangle t; the pair is complete except for that.
TOILE_HD inline bool is_facing_triangle(const SurfaceEdgesView& edges, View<const Triangle> triangles,
                                        View<const Vec3> x, const NearPair& pair, int t)
{
    // Corners with weight in the closest point.
    const auto is_on = [&](int k) { return -pair.weight[1 + k] > kOffCorner; };
    const int count = int(is_on(0)) + int(is_on(1)) + int(is_on(2));
    const Vec3& p = x[pair.vertex[0]];
    if (count == 3)
        return true;

    if (count == 2) {
        const int k = !is_on(2) ? 0 : !is_on(0) ? 1 : 2;
        const int e = edges.triangle_edge[t][k];
        const std::array<int, 2>& end = edges.vertex[e];
        const View<const int> incident = edges.triangles.of(e);
        return incident[0] == t && std::all_of(incident.begin(), incident.end(), [&](int other) {
                   return is_closest_on(triangles, x, p, other,
                                        [&](int v) { return v == end[0] || v == end[1]; });
               });
    }

    const int corner = pair.vertex[is_on(0) ? 1 : is_on(1) ? 2 : 3];
    const View<const int> incident = edges.corners_of_vertex.of(corner);
    return pair.vertex[0] < corner && incident[0] / 3 == t &&
           std::all_of(incident.begin(), incident.end(), [&](int other) {
               return is_closest_on(triangles, x, p, other / 3, [&](int v) { return v == corner; });
           });
}

/// NearPair::is_facing of edges e and f; the pair is complete except for that.
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

} // namespace toile::collision
