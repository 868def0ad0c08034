#pragma once

/// Triangle surface at one time, with its normals and closest points. The same bodies run on CPU and GPU.

#include <cmath>

#include "collision/geometry/distance.h"
#include "collision/geometry/surface_edges.h"
#include "core/compute/types.h"

namespace toile::collision {

/// Cosine of the angle [-] within which a search for other sheets assigns a face to the same sheet (30
/// degrees).
inline constexpr double kUnlikeCosine = 0.866;

/// Distance [m] below which two closest points are the same one, reached through neighbouring triangles.
inline constexpr double kSamePoint = 1e-9;

/// Cosine of the angle between face normals [-] above which an edge counts as flat: 1 degree.
inline constexpr double kRidgeCosine = 0.99984769515639;

/// Point on a triangle surface, seen from a query point p.
struct SurfacePoint {
    int triangle = -1;                                ///< lowest of the triangles that meet at the point
    TriangleFeature feature = TriangleFeature::kFace; ///< feature of that triangle on which the point lies
    Vec3 barycentric = Vec3::Zero();                  ///< weights of the triangle's corners
    Vec3 point = Vec3::Zero();                        ///< [m]
    /// Unit pseudo-normal of the feature: the normal of a face, the sum over an edge's faces, or the
    /// angle-weighted sum around a vertex. It gives the right sign on a closed mesh whichever feature is
    /// closest; no single face normal does. [Baerentzen and Aanaes 2005]
    Vec3 normal = Vec3::Zero();
    double signed_distance = 0.0; ///< [m] |p - point|, negative behind the surface: normal.(p - point) < 0

    TOILE_HD double distance() const { return std::abs(signed_distance); }
    TOILE_HD bool is_at(const Vec3& other) const
    {
        return (point - other).squaredNorm() < kSamePoint * kSamePoint;
    }
};

/// Closest point of one triangle.
struct NearTriangle {
    int triangle = -1; ///< -1: none
    ClosestOnTriangle closest;
};

TOILE_HD inline Vec3 unit_or_zero(const Vec3& v, double min_length = 1e-12)
{
    const double length = v.norm();
    return length > min_length ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Borrowed surface. Normals are computed on demand: a refit would compute every one, while queries need few.
struct SurfaceView {
    View<const Triangle> triangles;
    View<const Vec3> positions; ///< [vertices] [m]
    SurfaceEdgesView edges;

    TOILE_HD const Vec3& corner(int t, int k) const { return positions[triangles[t][k]]; }
    TOILE_HD ClosestOnTriangle closest_on(int t, const Vec3& p) const
    {
        return closest_on_triangle(p, corner(t, 0), corner(t, 1), corner(t, 2));
    }
    TOILE_HD Vec3 face_normal(int t) const;   ///< unit, or zero for a triangle of no area
    TOILE_HD Vec3 edge_normal(int e) const;   ///< unit, or zero if all its triangles have no area
    TOILE_HD Vec3 vertex_normal(int v) const; ///< angle-weighted; unit, or zero likewise

    /// True if cloth can rest on an edge: a ridge of at least 1 degree between its faces, or a border. Flat
    /// edges add nothing to their faces; in a valley cloth reaches the faces first.
    TOILE_HD bool is_ridge(int edge) const;

    /// Completes a closest point with its pseudo-normal and signed distance.
    /// @param near  closest point on one of the triangles that it lies on
    TOILE_HD SurfacePoint surface_point(const NearTriangle& near, const Vec3& p) const;

    /// True if no triangle that shares the closest point's edge or vertex comes nearer to p. A sharing
    /// triangle comes nearer exactly if one of its edges out of the closest point leads nearer. Its angle at
    /// that point is below 180 degrees, so a direction between the two edges leads nearer only if one of them
    /// does.
    TOILE_HD bool is_local_minimum(const NearTriangle& near, const Vec3& p) const;

    /// Local minimum of the distance from p, found by a walk over the surface. Each step goes to a touching
    /// triangle that is nearer.
    TOILE_HD SurfacePoint closest_from(const Vec3& p, int triangle) const;

    /// Lowest triangle on which the closest point's edge or vertex is also closest. Rounding decides which of
    /// the adjacent triangles comes out nearest.
    TOILE_HD NearTriangle lowest_at(const NearTriangle& near, const Vec3& p) const;

private:
    /// Calls visit(3 * triangle + corner) for the triangles around the closest point's vertex, or for those
    /// at its edge with corner 0. Calls nothing inside a face.
    template <typename Visit>
    TOILE_HD void visit_sharing(const NearTriangle& near, const Visit& visit) const
    {
        if (const int k = edge_of(near.closest.feature); k >= 0) {
            for (const int t : edges.triangles.of(edges.triangle_edge[near.triangle][k]))
                visit(3 * t);
        } else if (const int c = vertex_of(near.closest.feature); c >= 0) {
            for (const int corner : edges.corners_of_vertex.of(triangles[near.triangle][c]))
                visit(corner);
        }
    }
};

TOILE_HD inline Vec3 SurfaceView::face_normal(int t) const
{
    const Vec3 doubled_area = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    return unit_or_zero(doubled_area, 0.0);
}

TOILE_HD inline Vec3 SurfaceView::edge_normal(int e) const
{
    Vec3 sum = Vec3::Zero();
    for (const int t : edges.triangles.of(e))
        sum += face_normal(t);
    return unit_or_zero(sum);
}

TOILE_HD inline Vec3 SurfaceView::vertex_normal(int v) const
{
    Vec3 sum = Vec3::Zero();
    const Vec3& x = positions[v];
    for (const int index : edges.corners_of_vertex.of(v)) {
        const int t = index / 3;
        const Vec3 next = corner(t, (index + 1) % 3) - x;
        const Vec3 previous = corner(t, (index + 2) % 3) - x;
        sum += std::atan2(next.cross(previous).norm(), next.dot(previous)) * face_normal(t);
    }
    return unit_or_zero(sum);
}

TOILE_HD inline bool SurfaceView::is_ridge(int edge) const
{
    const View<const int> sides = edges.triangles.of(edge);
    if (sides.size() != 2)
        return true;
    const Vec3 n0 = face_normal(sides[0]);
    if (n0.dot(face_normal(sides[1])) > kRidgeCosine)
        return false;

    // Ridge: the other face's third corner lies below this face.
    const int a = edges.vertex[edge][0], b = edges.vertex[edge][1];
    for (int k = 0; k < 3; ++k) {
        const int v = triangles[sides[1]][k];
        if (v != a && v != b && !(n0.dot(positions[v] - positions[a]) < 0.0))
            return false;
    }
    return true;
}

TOILE_HD inline NearTriangle SurfaceView::lowest_at(const NearTriangle& near, const Vec3& p) const
{
    if (const int k = edge_of(near.closest.feature); k >= 0) {
        const int edge = edges.triangle_edge[near.triangle][k];
        for (const int t : edges.triangles.of(edge)) {
            if (t >= near.triangle)
                break;
            NearTriangle other{t, closest_on(t, p)};
            const int index = edge_of(other.closest.feature);
            if (index >= 0 && edges.triangle_edge[t][index] == edge)
                return other;
        }
    } else if (const int c = vertex_of(near.closest.feature); c >= 0) {
        const int vertex = triangles[near.triangle][c];
        for (const int corner : edges.corners_of_vertex.of(vertex)) {
            if (corner / 3 >= near.triangle)
                break;
            NearTriangle other{corner / 3, closest_on(corner / 3, p)};
            const int index = vertex_of(other.closest.feature);
            if (index >= 0 && triangles[other.triangle][index] == vertex)
                return other;
        }
    }
    return near;
}

TOILE_HD inline SurfacePoint SurfaceView::surface_point(const NearTriangle& near, const Vec3& p) const
{
    const NearTriangle lowest = lowest_at(near, p);
    const int t = lowest.triangle;
    const ClosestOnTriangle& closest = lowest.closest;
    SurfacePoint result{t, closest.feature, closest.barycentric, closest.point, Vec3::Zero(), 0.0};
    if (const int k = edge_of(closest.feature); k >= 0)
        result.normal = edge_normal(edges.triangle_edge[t][k]);
    else if (const int c = vertex_of(closest.feature); c >= 0)
        result.normal = vertex_normal(triangles[t][c]);

    // Fall back to the face's normal, then to the direction to p, then to up.
    const double distance = std::sqrt(closest.distance2);
    if (result.normal.isZero(0.0))
        result.normal = face_normal(t);
    if (result.normal.isZero(0.0))
        result.normal = distance > 0.0 ? Vec3((p - closest.point) / distance) : Vec3(Vec3::UnitY());
    result.signed_distance = result.normal.dot(p - closest.point) < 0.0 ? -distance : distance;
    return result;
}

TOILE_HD inline bool SurfaceView::is_local_minimum(const NearTriangle& near, const Vec3& p) const
{
    constexpr double kAngleSlack = 1e-9;     // [-]
    constexpr double kPositionSlack = 1e-14; // [m] rounding of coordinates of a few metres
    const Vec3 towards_p = p - near.closest.point;
    const double slack = kAngleSlack * towards_p.norm() + kPositionSlack;
    const bool is_vertex = vertex_of(near.closest.feature) >= 0;
    bool leads_nearer = false;
    visit_sharing(near, [&](int index) {
        for (int k = is_vertex ? 1 : 0; k < 3 && !leads_nearer; ++k) {
            const Vec3 step = corner(index / 3, (index + k) % 3) - near.closest.point;
            leads_nearer = towards_p.dot(step) > slack * step.norm();
        }
    });
    return !leads_nearer;
}

TOILE_HD inline SurfacePoint SurfaceView::closest_from(const Vec3& p, int triangle) const
{
    // Only triangles at the closest point can be nearer.
    NearTriangle best{triangle, closest_on(triangle, p)};
    for (int last = -1; last != best.triangle;) {
        last = best.triangle;
        const NearTriangle from = best;
        visit_sharing(from, [&](int corner) {
            const NearTriangle other{corner / 3, closest_on(corner / 3, p)};
            if (other.closest.distance2 < best.closest.distance2)
                best = other;
        });
    }
    return surface_point(best, p);
}

/// Surface that moves during the step, at its end t1.
struct MeshPose {
    SurfaceView surface;   ///< at t1
    View<const Vec3> x_t0; ///< [vertices] [m]

    /// Displacement of a vertex from t0 to t1 [m].
    TOILE_HD Vec3 motion(int vertex) const { return surface.positions[vertex] - x_t0[vertex]; }

    /// Displacement of a point of a triangle from t0 to t1 [m].
    TOILE_HD Vec3 motion(int triangle, const Vec3& barycentric) const
    {
        const Triangle& corner = surface.triangles[triangle];
        return barycentric[0] * motion(corner[0]) + barycentric[1] * motion(corner[1]) +
               barycentric[2] * motion(corner[2]);
    }
};

} // namespace toile::collision
