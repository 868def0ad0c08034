#pragma once

/// Rules of which points of cloth and mesh form a contact pair, and of the pair's normal and feature. The
/// same bodies run on CPU and GPU; each finds candidates by its own search.

#include <array>

#include "collision/geometry/contact_pair.h"
#include "collision/geometry/surface_view.h"

namespace toile::collision {

/// Distance [m] below which the direction between two closest points is rounding noise. The collider's own
/// normal replaces it.
inline constexpr double kTouchDistance = 1e-6;

/// Cosine of the minimum angle between two planes of a vertex [-]: 45 degrees.
inline constexpr double kDistinctCosine = 0.7071;

/// Maximum depth to which a collider vertex may have pierced the cloth, in radii [-].
inline constexpr double kMaxPenetrationRadii = 1.0;

/// Minimum |cos| between the vertex normal and the direction to the cloth [-]: 45 degrees. Cloth to the side
/// of the vertex is left to pairs of the cloth's own vertices and edges.
inline constexpr double kAheadCosine = 0.7071;

/// Minimum |cos| between the direction to the cloth and the ridge's pseudo-normal [-]: 60 degrees. Beyond it
/// the closest points lie on the faces adjacent to the ridge.
inline constexpr double kConeCosine = 0.5;

/// Gradient of the signed distance: the direction between vertex and surface, oriented outwards.
TOILE_HD inline Vec3 outward(const SurfacePoint& surface, const Vec3& x)
{
    return surface.distance() > kTouchDistance ? Vec3((x - surface.point) / surface.signed_distance)
                                               : surface.normal;
}

/// Contact planes of one cloth vertex. First comes the closest point, or instead the sheets that the vertex
/// has passed through since it was in front of them. Then come other sheets that the vertex is in front of,
/// nearest first.
struct VertexPlanes {
    static constexpr int kMax = 3; ///< a corner needs three; more would repeat them

    Vec3 x;           ///< the vertex [m]
    double radius;    ///< [m] maximum distance in front
    double max_depth; ///< [m] maximum depth behind
    int count = 0;
    std::array<Vec3, kMax> normal{};

    TOILE_HD VertexPlanes(const Vec3& vertex, double in_front, double behind)
        : x(vertex), radius(in_front), max_depth(behind)
    {
    }

    TOILE_HD bool is_full() const { return count == kMax; }
    TOILE_HD bool is_distinct(const Vec3& n) const
    {
        for (int k = 0; k < count; ++k)
            if (!(normal[k].dot(n) < kDistinctCosine))
                return false;
        return true;
    }

    /// Calls add(surface point) for the first planes. Sheets in `behind` count only inside a body: outside, a
    /// recorded sheet's closest point may face away from cloth that has moved around it.
    /// @param behind  sheets that the vertex has passed through; empty if it is in front of the nearest
    ///                surface
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

    /// True if another sheet adds a plane.
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

/// Pair of cloth vertex v at x and a point on the mesh.
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

/// True if a mesh vertex with unit or zero normal n and a sheet of cloth form a pair.
/// @param sheet            cloth point nearest to the mesh vertex, which is at x [m]
/// @param radius           [m] of the sheet's corners
/// @param is_inside_below  (c, reach, n): see find_pairs.h
template <typename IsInsideBelow>
TOILE_HD bool meets_sheet(const Vec3& x, const Vec3& n, const SurfacePoint& sheet, double radius,
                          const IsInsideBelow& is_inside_below)
{
    // If the closest point is a cloth vertex, that vertex forms the pair.
    if (vertex_of(sheet.feature) >= 0 || sheet.distance() > kMaxPenetrationRadii * radius)
        return false;
    const double gap = n.dot(sheet.point - x);
    const bool is_ahead =
        sheet.distance() < kTouchDistance || std::abs(gap) > kAheadCosine * sheet.distance();
    if (n.isZero(0.0) || !is_ahead || gap >= radius)
        return false;
    return !(gap < -kTouchDistance) || is_inside_below(sheet.point, sheet.distance(), n);
}

/// Pair of mesh vertex v with normal n and a sheet of cloth with the given corners.
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

/// Closest points of segment a and ridge b if both lie strictly inside; s < 0 otherwise. Cheaper than
/// closest_on_segments: most candidates are rejected without a division.
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

/// True if a ridge of the mesh and a cloth edge with the given closest points form a pair, which is written
/// to `pair`.
/// @param end              vertices of the cloth edge, at a0 and a1 [m]
/// @param is_inside_below  (c, reach, n): see find_pairs.h
template <typename IsInsideBelow>
TOILE_HD bool meets_ridge(const MeshPose& mesh, int collider, const std::array<int, 2>& end, const Vec3& a0,
                          const Vec3& a1, int ridge, const ClosestOnSegments& closest,
                          const IsInsideBelow& is_inside_below, ContactPair& pair)
{
    const Vec3 pseudo_normal = mesh.surface.edge_normal(ridge);
    if (pseudo_normal.isZero(0.0))
        return false;

    // Outside, the normal is the direction between the edges, if it lies within the ridge's cone. Touching or
    // inside, it is the ridge's own normal.
    const std::array<int, 2>& v = mesh.surface.edges.vertex[ridge];
    const double s = closest.s, t = closest.t;
    const Vec3 on_cloth = (1.0 - s) * a0 + s * a1;
    const Vec3 on_ridge = (1.0 - t) * mesh.surface.positions[v[0]] + t * mesh.surface.positions[v[1]];
    const double distance = std::sqrt(closest.distance2);
    Vec3 normal = pseudo_normal;
    if (distance > kTouchDistance) {
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

/// Factor on the reach of is_inside_below [-], so that rounding does not exclude the feature itself.
inline constexpr double kReachSlack = 1.0 + 1e-6;

/// Result of is_inside_below, given the nearest surface point.
TOILE_HD inline bool is_below(const SurfacePoint& nearest, const Vec3& n)
{
    return nearest.signed_distance < 0.0 && nearest.normal.dot(n) > 0.0;
}

} // namespace toile::collision
