#pragma once

/// Exact closest points between the primitives of triangle meshes, in double precision. Every function is
/// defined for degenerate primitives too: a segment may be a point, a triangle a segment.

#include <cmath>

#include <Eigen/Geometry>

#include "core/compute/types.h"

namespace toile::collision {

/// Squared sine of the angle between two segments below which they count as parallel [-]. The closed form of
/// their crossing loses all digits there, so end points are tried as well.
inline constexpr double kParallelSine2 = 1e-10;

/// Squared ratio of a triangle's height to its size below which it counts as a segment [-]. Its plane has no
/// direction left in double precision, so only its edges are tried.
inline constexpr double kFlatTriangle2 = 1e-22;

/// Feature of a triangle on which a point lies. Edge k runs from corner k to corner k + 1.
enum class TriangleFeature { kEdge0, kEdge1, kEdge2, kVertex0, kVertex1, kVertex2, kFace };

/// Edge or vertex number of a feature (0, 1, 2); -1 otherwise.
TOILE_HD inline int edge_of(TriangleFeature feature)
{
    return feature <= TriangleFeature::kEdge2 ? int(feature) : -1;
}
TOILE_HD inline int vertex_of(TriangleFeature feature)
{
    return feature >= TriangleFeature::kVertex0 && feature <= TriangleFeature::kVertex2
               ? int(feature) - int(TriangleFeature::kVertex0)
               : -1;
}

/// Point of a triangle closest to a query point.
struct ClosestOnTriangle {
    Vec3 point = Vec3::Zero();       ///< [m]
    Vec3 barycentric = Vec3::Zero(); ///< weights of the corners, >= 0, sum 1; exactly 0 off the feature
    double distance2 = 0.0;          ///< [m^2] squared distance
    TriangleFeature feature = TriangleFeature::kFace;
};

/// Parameter in [0, 1] of the point of segment a b closest to p; 0 for a segment of no length.
TOILE_HD inline double closest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b)
{
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    const double along = ab.dot(p - a);
    if (!(along > 0.0) || !(length2 > 0.0))
        return 0.0;
    return along >= length2 ? 1.0 : along / length2;
}

/// Closest point on the border of triangle (a, b, c): the best of its three edges.
TOILE_HD inline ClosestOnTriangle closest_on_triangle_edges(const Vec3& p, const Vec3& a, const Vec3& b,
                                                            const Vec3& c)
{
    const Vec3 corner[3] = {a, b, c};
    ClosestOnTriangle best;
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const double s = closest_on_segment(p, corner[k], corner[next]);
        const Vec3 point = corner[k] + s * (corner[next] - corner[k]);
        const double distance2 = (p - point).squaredNorm();
        if (k > 0 && !(distance2 < best.distance2))
            continue;
        best.point = point;
        best.distance2 = distance2;
        best.barycentric = Vec3::Zero();
        best.barycentric[k] = 1.0 - s;
        best.barycentric[next] = s;
        best.feature = s <= 0.0   ? TriangleFeature(3 + k)
                       : s >= 1.0 ? TriangleFeature(3 + next)
                                  : TriangleFeature(k);
    }
    return best;
}

/// Point of triangle (a, b, c) closest to p, by the Voronoi regions of its features.
/// [Ericson 2005, Real-Time Collision Detection, section 5.1.5]
TOILE_HD inline ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                      const Vec3& c)
{
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double size2 = ab.squaredNorm() + ac.squaredNorm();
    if (!(ab.cross(ac).squaredNorm() > kFlatTriangle2 * size2 * size2))
        return closest_on_triangle_edges(p, a, b, c);

    // Test the regions of the corners, then of the edges, by signed areas (va, vb, vc).
    const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
    const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
    const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    ClosestOnTriangle closest;
    const auto at = [&](TriangleFeature feature, double wa, double wb, double wc) {
        closest.feature = feature;
        closest.barycentric = Vec3(wa, wb, wc);
        closest.point = a + wb * ab + wc * ac;
        closest.distance2 = (p - closest.point).squaredNorm();
    };
    if (d1 <= 0.0 && d2 <= 0.0)
        at(TriangleFeature::kVertex0, 1.0, 0.0, 0.0);
    else if (d3 >= 0.0 && d4 <= d3)
        at(TriangleFeature::kVertex1, 0.0, 1.0, 0.0);
    else if (d6 >= 0.0 && d5 <= d6)
        at(TriangleFeature::kVertex2, 0.0, 0.0, 1.0);
    else if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0)
        at(TriangleFeature::kEdge0, -d3 / (d1 - d3), d1 / (d1 - d3), 0.0);
    else if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        at(TriangleFeature::kEdge1, 0.0, 1.0 - w, w);
    } else if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0)
        at(TriangleFeature::kEdge2, -d6 / (d2 - d6), 0.0, d2 / (d2 - d6));
    else {
        const double sum = va + vb + vc;
        at(TriangleFeature::kFace, va / sum, vb / sum, vc / sum);
    }
    return closest;
}

/// Closest points of two segments: a0 + s (a1 - a0) and b0 + t (b1 - b0).
struct ClosestOnSegments {
    double s = 0.0; ///< in [0, 1]
    double t = 0.0; ///< in [0, 1]
    double distance2 = 0.0;
};

TOILE_HD inline ClosestOnSegments at_parameters(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                                const Vec3& b1, double s, double t)
{
    return {s, t, (a0 + s * (a1 - a0) - b0 - t * (b1 - b0)).squaredNorm()};
}

/// Closest points of segments a and b: crosses the carrier lines, then clamps. [Ericson 2005, Real-Time
/// Collision Detection, section 5.1.9]
///
/// For nearly parallel segments the crossing loses its digits, so the four end points are tried as well
/// (deviation). Overlapping parallel segments have many closest pairs; the result includes an end point.
TOILE_HD inline ClosestOnSegments closest_on_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                                      const Vec3& b1)
{
    const Vec3 da = a1 - a0;
    const Vec3 db = b1 - b0;
    const Vec3 gap = a0 - b0;
    const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
    const double determinant = aa * bb - ab * ab;

    // Cross the lines at s; take the point of b closest to it, clamped; return to a.
    const double crossing = determinant > 0.0 ? (ab * db.dot(gap) - bb * da.dot(gap)) / determinant : 0.0;
    const double on_a = std::fmin(std::fmax(crossing, 0.0), 1.0);
    const double t = closest_on_segment(a0 + on_a * da, b0, b1);
    const double s = t > 0.0 && t < 1.0 ? on_a : closest_on_segment(b0 + t * db, a0, a1);
    ClosestOnSegments best = at_parameters(a0, a1, b0, b1, s, t);
    if (determinant > kParallelSine2 * aa * bb)
        return best;

    const ClosestOnSegments ends[4] = {at_parameters(a0, a1, b0, b1, 0.0, closest_on_segment(a0, b0, b1)),
                                       at_parameters(a0, a1, b0, b1, 1.0, closest_on_segment(a1, b0, b1)),
                                       at_parameters(a0, a1, b0, b1, closest_on_segment(b0, a0, a1), 0.0),
                                       at_parameters(a0, a1, b0, b1, closest_on_segment(b1, a0, a1), 1.0)};
    for (const ClosestOnSegments& end : ends)
        if (end.distance2 <= best.distance2)
            best = end;
    return best;
}

} // namespace toile::collision
