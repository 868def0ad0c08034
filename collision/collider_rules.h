#pragma once

/// Which places of cloth and mesh are pairs, and what there is to know about one. The same bodies on CPU and
/// GPU; what is near what, either finds in its own way.

#include <array>

#include "collision/contact_pair.h"
#include "collision/surface_view.h"

namespace toile {

/// Distance [m] below which the direction between two closest points is rounding: the collider's own normal
/// takes its place.
inline constexpr double kTouching = 1e-6;

/// cos of the least angle between two planes of a vertex [-]: 45 degrees.
inline constexpr double kDistinctCosine = 0.7071;

/// How deep a collider vertex may have pierced the cloth, in radii [-].
inline constexpr double kPiercedRadii = 1.0;

/// Least |cos| between the vertex normal and the direction to the cloth [-]: 45 degrees. Cloth that passes
/// sideways is the business of its own vertices and edges.
inline constexpr double kAheadCosine = 0.7071;

/// Least |cos| between the direction to the cloth and the ridge's pseudo-normal [-]: 60 degrees. Beyond it
/// the closest points lie on the faces beside the ridge.
inline constexpr double kConeCosine = 0.5;

/// Gradient of the signed distance: the direction between vertex and surface, turned outwards.
TOILE_HD inline Vec3 outward(const SurfacePoint& surface, const Vec3& x)
{
    return surface.distance() > kTouching ? Vec3((x - surface.point) / surface.signed_distance)
                                          : surface.normal;
}

/// The planes of one cloth vertex, as they are chosen: the closest point or, where it has come behind sheets
/// that it was in front of, those; then other sheets that it stands in front of, nearest first.
struct VertexPlanes {
    static constexpr int kMost = 3; ///< a corner needs three, more would only repeat them

    Vec3 x;           ///< the vertex [m]
    double radius;    ///< [m] largest distance in front
    double max_depth; ///< [m] and behind
    int count = 0;
    std::array<Vec3, kMost> normal{};

    TOILE_HD VertexPlanes(const Vec3& vertex, double in_front, double behind)
        : x(vertex), radius(in_front), max_depth(behind)
    {
    }

    TOILE_HD bool is_full() const { return count == kMost; }
    TOILE_HD bool is_distinct(const Vec3& n) const
    {
        for (int k = 0; k < count; ++k)
            if (!(normal[k].dot(n) < kDistinctCosine))
                return false;
        return true;
    }

    /// Calls add(surface point) for the first planes. Sheets count only inside a body: outside, the place on
    /// a remembered sheet may face away from cloth that has gone round it.
    /// @param behind  sheets that it has come behind; empty where it is in front of the nearest
    template <typename Add>
    TOILE_HD void take_first(const SurfacePoint& nearest, View<const SurfacePoint> behind, const Add& add)
    {
        const bool is_behind = nearest.signed_distance < 0.0;
        if (is_behind ? behind.empty() && nearest.distance() < max_depth : nearest.distance() < radius)
            take(nearest, add);
        for (const SurfacePoint& sheet : behind)
            if (!is_full() && is_distinct(outward(sheet, x)))
                take(sheet, add);
    }

    /// True of another sheet that makes a plane.
    TOILE_HD bool is_wanted(const SurfacePoint& sheet) const
    {
        return sheet.signed_distance >= 0.0 && sheet.distance() < radius && is_distinct(outward(sheet, x));
    }

    template <typename Add>
    TOILE_HD void take(const SurfacePoint& at, const Add& add)
    {
        normal[count++] = outward(at, x);
        add(at);
    }
};

/// The pair of cloth vertex v, which is at x, and a place on the mesh.
TOILE_HD inline ContactPair vertex_face_pair(const MeshPose& mesh, int collider, int v, const Vec3& x,
                                             const SurfacePoint& at)
{
    ContactPair pair;
    pair.vertex = contact_vertices(v);
    pair.weight = {1.0, 0.0, 0.0, 0.0};
    pair.normal = outward(at, x);
    pair.point = at.point;
    pair.motion = mesh.motion(at.triangle, at.barycentric);
    pair.collider = collider;
    pair.kind = ContactKind::kVertexFace;
    pair.feature = at.triangle;
    return pair;
}

/// True when a vertex of the mesh with unit or zero normal n and a sheet of cloth make a pair.
/// @param sheet            the place on the cloth that is nearest to the vertex, which is at x [m]
/// @param radius           [m] of the sheet's corners
/// @param is_inside_below  (c, reach, n): see find_pairs.h
template <typename IsInsideBelow>
TOILE_HD bool meets_sheet(const Vec3& x, const Vec3& n, const SurfacePoint& sheet, double radius,
                          const IsInsideBelow& is_inside_below)
{
    // Above a cloth vertex the vertex itself makes the pair.
    if (vertex_of(sheet.feature) >= 0 || sheet.distance() > kPiercedRadii * radius)
        return false;
    const double gap = n.dot(sheet.point - x);
    const bool is_ahead = sheet.distance() < kTouching || std::abs(gap) > kAheadCosine * sheet.distance();
    if (n.isZero(0.0) || !is_ahead || gap >= radius)
        return false;
    return !(gap < -kTouching) || is_inside_below(sheet.point, sheet.distance(), n);
}

/// The pair of vertex v of the mesh, of normal n, and a sheet of cloth with the given corners.
TOILE_HD inline ContactPair face_vertex_pair(const MeshPose& mesh, int collider, int v, const Vec3& n,
                                             const Triangle& corner, const SurfacePoint& sheet)
{
    ContactPair pair;
    pair.vertex = contact_vertices(corner[0], corner[1], corner[2]);
    pair.weight = {sheet.barycentric[0], sheet.barycentric[1], sheet.barycentric[2], 0.0};
    pair.normal = n;
    pair.point = mesh.surface.positions[v];
    pair.motion = mesh.motion(v);
    pair.collider = collider;
    pair.kind = ContactKind::kFaceVertex;
    pair.feature = v;
    return pair;
}

/// The closest points of segment a and ridge b when both lie strictly inside; s < 0 otherwise. Cheaper than
/// closest_on_segments: most candidates leave without a division.
TOILE_HD inline ClosestOnSegments crossing(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1)
{
    constexpr ClosestOnSegments kNone{-1.0, -1.0, 0.0};
    const Vec3 da = a1 - a0, db = b1 - b0, gap = a0 - b0;
    const double aa = da.squaredNorm(), bb = db.squaredNorm(), ab = da.dot(db);
    const double ga = da.dot(gap), gb = db.dot(gap);
    const double determinant = aa * bb - ab * ab;
    const double s = ab * gb - bb * ga;
    const double t = aa * gb - ab * ga;
    if (!(s > 0.0 && s < determinant && t > 0.0 && t < determinant) ||
        !(determinant > kParallelSine2 * aa * bb))
        return kNone;
    return at_parameters(a0, a1, b0, b1, s / determinant, t / determinant);
}

/// True when a ridge of the mesh can push a cloth edge, whose closest points are given; then `pair` is
/// theirs.
/// @param end              vertices of the cloth edge, which are at a0 and a1 [m]
/// @param is_inside_below  (c, reach, n): see find_pairs.h
template <typename IsInsideBelow>
TOILE_HD bool meets_ridge(const MeshPose& mesh, int collider, const std::array<int, 2>& end, const Vec3& a0,
                          const Vec3& a1, int ridge, const ClosestOnSegments& closest,
                          const IsInsideBelow& is_inside_below, ContactPair& pair)
{
    const Vec3 pseudo_normal = mesh.surface.edge_normal(ridge);
    if (pseudo_normal.isZero(0.0))
        return false;

    // Outside: the direction between the edges, when the ridge can push that way. Touching or inside: the
    // ridge's own normal.
    const std::array<int, 2>& v = mesh.surface.edges.vertex[ridge];
    const double s = closest.s, t = closest.t;
    const Vec3 on_cloth = (1.0 - s) * a0 + s * a1;
    const Vec3 on_ridge = (1.0 - t) * mesh.surface.positions[v[0]] + t * mesh.surface.positions[v[1]];
    const double distance = std::sqrt(closest.distance2);
    Vec3 normal = pseudo_normal;
    if (distance > kTouching) {
        const Vec3 direction = (on_cloth - on_ridge) / distance;
        const double ahead = direction.dot(pseudo_normal);
        if (std::abs(ahead) < kConeCosine ||
            (ahead < 0.0 && !is_inside_below(on_cloth, distance, pseudo_normal)))
            return false;
        if (ahead > 0.0)
            normal = direction;
    }

    pair = ContactPair();
    pair.vertex = contact_vertices(end[0], end[1]);
    pair.weight = {1.0 - s, s, 0.0, 0.0};
    pair.normal = normal;
    pair.point = on_ridge;
    pair.motion = (1.0 - t) * mesh.motion(v[0]) + t * mesh.motion(v[1]);
    pair.collider = collider;
    pair.kind = ContactKind::kEdgeEdge;
    pair.feature = ridge;
    return true;
}

/// The feature itself must be found where is_inside_below looks for what is below it.
inline constexpr double kReachSlack = 1.0 + 1e-6;

/// is_inside_below of the surface that is nearest.
TOILE_HD inline bool is_below(const SurfacePoint& nearest, const Vec3& n)
{
    return nearest.signed_distance < 0.0 && nearest.normal.dot(n) > 0.0;
}

} // namespace toile
