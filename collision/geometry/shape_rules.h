#pragma once

/// Rules of which faces and edges of cloth form pairs with corners and edges of a solid. The same bodies run
/// on CPU and GPU.

#include <array>
#include <cmath>
#include <limits>

#include "collision/geometry/collider_rules.h"
#include "collision/geometry/shape_skeleton.h"
#include "collision/geometry/solid.h"

namespace toile::collision {

/// Distance [m] by which a face or edge must be nearer to a round shape than its vertices to form its own
/// pair, which is a whole contact at twice that distance. Normally well below the contact thickness, so that
/// fine cloth needs vertex pairs only.
inline constexpr double kSag = 1e-4;

/// Minimum cosine between a pair's normal and the faces adjacent to a sharp corner or edge [-]. Negative, so
/// that a sheet nearly flat on a face still meets all its corners. Above -0.408, so that the solid's side is
/// unambiguous.
inline constexpr double kMinFaceCosine = -0.4;

/// Maximum slope of a sheet over a sharp feature's flank [-] for which cloth behind the feature still counts
/// as inside. Such cloth lies beside the flank.
inline constexpr double kInsideSlope = 0.1;

/// ShapeSkeleton as plain data.
struct PlainSkeleton {
    std::array<ShapeSkeleton::Corner, 8> corners;
    std::array<ShapeSkeleton::Edge, 12> edges;
    int corner_count = 0, edge_count = 0;
    double radius = 0.0; ///< [m] 0: sharp

    TOILE_HD bool is_round() const { return radius > 0.0; }

    /// ShapeSkeleton::distance.
    TOILE_HD double distance(const Vec3& x) const
    {
        double squared = std::numeric_limits<double>::infinity();
        for (int k = 0; k < corner_count; ++k)
            squared = std::fmin(squared, (x - corners[k].point).squaredNorm());
        for (int k = 0; k < edge_count; ++k) {
            const ShapeSkeleton::Edge& edge = edges[k];
            const double t = closest_on_segment(x, edge.a, edge.b);
            squared = std::fmin(squared, (x - edge.a - t * (edge.b - edge.a)).squaredNorm());
        }
        return std::sqrt(squared) - radius;
    }
};
PlainSkeleton plain(const ShapeSkeleton& skeleton);

/// Pairs of a cloth and a solid.
template <typename Solid>
struct ShapeRules {
    View<const Triangle> triangles;
    SurfaceEdgesView edges;
    View<const Vec3> x; ///< [vertices] [m]
    MovingSolid<Solid> solid;
    PlainSkeleton skeleton;      ///< at t1
    View<const double> distance; ///< [vertices] to the skeleton [m]
    int collider;
    double radius; ///< [m] points closer than this become pairs

    /// Call add(pair) for a cloth vertex; for a face against corners; for an edge against corners, then
    /// edges.
    template <typename Add>
    TOILE_HD void visit_vertex(int v, const Add& add) const;
    template <typename Add>
    TOILE_HD void visit_face(int t, const Add& add) const;
    template <typename Add>
    TOILE_HD void visit_edge(int e, const Add& add) const;

private:
    /// Closest points of a cloth face or edge and a corner or edge of the skeleton.
    struct Meeting {
        std::array<int, 4> vertex;
        std::array<double, 4> weight;
        Vec3 on_cloth;          ///< [m]
        Vec3 on_skeleton;       ///< [m]
        Vec3 across;            ///< unit, along their connection; also defined if that has no length
        View<const Vec3> faces; ///< adjacent to the skeleton's feature
        ContactKind kind;
        int feature;
    };

    TOILE_HD bool is_worth_testing(double min_distance, double longest) const;
    TOILE_HD bool is_nearest_of_its_faces(int edge, const Vec3& p) const;
    TOILE_HD bool has_pierced(const Vec3& c, const Vec3& n, double depth) const;
    template <typename Add>
    TOILE_HD void meet_corner(int e, int corner, const Add& add) const;
    template <typename Add>
    TOILE_HD void meet_edge(int e, int edge, const Add& add) const;
    template <typename Add>
    TOILE_HD void meet(const Meeting& meeting, const Add& add) const;
    TOILE_HD bool is_round_pair(const Meeting& meeting, ContactPair& pair) const;
    TOILE_HD bool is_sharp_pair(const Meeting& meeting, ContactPair& pair) const;
};

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::visit_vertex(int v, const Add& add) const
{
    const ShapePoint at = solid.closest(x[v]);
    if (!(at.signed_distance < radius))
        return;
    ContactPair pair;
    pair.vertex = contact_vertices(v);
    pair.weight = {1.0, 0.0, 0.0, 0.0};
    pair.normal = at.normal;
    pair.point = at.point;
    pair.motion = solid.motion(at.point);
    pair.collider = collider;
    pair.kind = ContactKind::kVertexShape;
    pair.feature = 0;
    add(pair);
}

/// False if a face or edge cannot form a pair. Either it is too far away, or it is too small for a round
/// shape to press between its vertices. A point of a triangle is at most longest / sqrt(3) from a vertex.
template <typename Solid>
TOILE_HD bool ShapeRules<Solid>::is_worth_testing(double min_distance, double longest) const
{
    if (skeleton.is_round() && longest * longest < 6.0 * skeleton.radius * kSag)
        return false;
    return min_distance - longest < radius;
}

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::visit_face(int t, const Add& add) const
{
    const Triangle& corner = triangles[t];
    const Vec3 &a = x[corner[0]], &b = x[corner[1]], &c = x[corner[2]];
    const double longest =
        std::sqrt(std::fmax(std::fmax((b - a).squaredNorm(), (c - b).squaredNorm()), (a - c).squaredNorm()));
    const double min_distance =
        std::fmin(std::fmin(distance[corner[0]], distance[corner[1]]), distance[corner[2]]);
    if (!is_worth_testing(min_distance, longest))
        return;
    const Vec3 across = (b - a).cross(c - a);
    if (!(across.norm() > 0.0))
        return;
    const double reach = longest + skeleton.radius + radius;
    for (int k = 0; k < skeleton.corner_count; ++k) {
        const Vec3& p = skeleton.corners[k].point;
        if ((p - a).squaredNorm() > reach * reach)
            continue;
        const ClosestOnTriangle at = closest_on_triangle(p, a, b, c);
        if (at.feature == TriangleFeature::kFace)
            meet({contact_vertices(corner[0], corner[1], corner[2]),
                  {at.barycentric[0], at.barycentric[1], at.barycentric[2], 0.0},
                  at.point,
                  p,
                  across.normalized(),
                  {skeleton.corners[k].faces.data(), 3},
                  ContactKind::kFaceShape,
                  k},
                 add);
    }
}

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::visit_edge(int e, const Add& add) const
{
    const std::array<int, 2>& end = edges.vertex[e];
    if (!is_worth_testing(std::fmin(distance[end[0]], distance[end[1]]), (x[end[1]] - x[end[0]]).norm()))
        return;
    for (int k = 0; k < skeleton.corner_count; ++k)
        meet_corner(e, k, add);
    for (int k = 0; k < skeleton.edge_count; ++k)
        meet_edge(e, k, add);
}

/// True if no face adjacent to the edge comes nearer to p than the edge.
template <typename Solid>
TOILE_HD bool ShapeRules<Solid>::is_nearest_of_its_faces(int edge, const Vec3& p) const
{
    for (const int t : edges.triangles.of(edge)) {
        const Triangle& corner = triangles[t];
        const int k = edge_of(closest_on_triangle(p, x[corner[0]], x[corner[1]], x[corner[2]]).feature);
        if (k < 0 || edges.triangle_edge[t][k] != edge)
            return false;
    }
    return true;
}

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::meet_corner(int e, int corner, const Add& add) const
{
    const std::array<int, 2>& end = edges.vertex[e];
    const Vec3 &a = x[end[0]], &b = x[end[1]], &p = skeleton.corners[corner].point;
    const double s = closest_on_segment(p, a, b);
    const Vec3 on_cloth = a + s * (b - a);
    const double length = (on_cloth - p).norm();
    if (s <= 0.0 || s >= 1.0 || length < kTouchDistance || length > skeleton.radius + radius ||
        !is_nearest_of_its_faces(e, p))
        return;
    meet({contact_vertices(end[0], end[1]),
          {1.0 - s, s, 0.0, 0.0},
          on_cloth,
          p,
          (on_cloth - p) / length,
          {skeleton.corners[corner].faces.data(), 3},
          ContactKind::kEdgeShape,
          corner},
         add);
}

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::meet_edge(int e, int edge, const Add& add) const
{
    const std::array<int, 2>& end = edges.vertex[e];
    const Vec3 &a0 = x[end[0]], &a1 = x[end[1]];
    const ShapeSkeleton::Edge& ridge = skeleton.edges[edge];
    const ClosestOnSegments at = closest_on_segments(a0, a1, ridge.a, ridge.b);
    const Vec3 da = a1 - a0, db = ridge.b - ridge.a, across = da.cross(db);
    if (!(at.s > 0.0 && at.s < 1.0 && at.t > 0.0 && at.t < 1.0) ||
        !(across.squaredNorm() > kParallelSine2 * da.squaredNorm() * db.squaredNorm()))
        return;
    meet({contact_vertices(end[0], end[1]),
          {1.0 - at.s, at.s, 0.0, 0.0},
          a0 + at.s * da,
          ridge.a + at.t * db,
          across.normalized(),
          {ridge.faces.data(), 2},
          ContactKind::kEdgeShape,
          skeleton.corner_count + edge},
         add);
}

template <typename Solid>
template <typename Add>
TOILE_HD void ShapeRules<Solid>::meet(const Meeting& meeting, const Add& add) const
{
    ContactPair pair;
    if (!(skeleton.is_round() ? is_round_pair(meeting, pair) : is_sharp_pair(meeting, pair)))
        return;
    pair.vertex = meeting.vertex;
    pair.weight = meeting.weight;
    pair.motion = solid.motion(pair.point);
    pair.collider = collider;
    pair.kind = meeting.kind;
    pair.feature = meeting.feature;
    add(pair);
}

/// Sets the pair's normal and point, as is_sharp_pair() does; true if it is a pair.
template <typename Solid>
TOILE_HD bool ShapeRules<Solid>::is_round_pair(const Meeting& meeting, ContactPair& pair) const
{
    const Vec3 offset = meeting.on_cloth - meeting.on_skeleton;
    const double length = offset.norm() - skeleton.radius;
    double at_vertices = distance[meeting.vertex[0]];
    for (int k = 1; k < 3 && meeting.vertex[k] >= 0; ++k)
        at_vertices = std::fmin(at_vertices, distance[meeting.vertex[k]]);
    pair.normal = offset.norm() > kTouchDistance ? Vec3(offset.normalized()) : meeting.across;
    pair.point = meeting.on_skeleton + skeleton.radius * pair.normal;
    pair.share = std::fmin(1.0, (at_vertices - length) / kSag - 1.0);
    return length < radius && pair.share > 0.0;
}

/// True if the cloth at c, `depth` behind a sharp feature with outward normal n, is pierced by that feature.
/// It must be inside the solid and not past its middle, beyond which the opposite side is the exit.
template <typename Solid>
TOILE_HD bool ShapeRules<Solid>::has_pierced(const Vec3& c, const Vec3& n, double depth) const
{
    return n.dot(c - solid.t1.origin) > 0.0 && solid.closest(c).signed_distance <= kInsideSlope * depth;
}

/// Orients the normal away from the solid; true if the cloth is in front of the feature, or inside behind it.
template <typename Solid>
TOILE_HD bool ShapeRules<Solid>::is_sharp_pair(const Meeting& meeting, ContactPair& pair) const
{
    Vec3 outwards = Vec3::Zero();
    for (const Vec3& face : meeting.faces)
        outwards += face;
    pair.normal = meeting.across.dot(outwards) < 0.0 ? Vec3(-meeting.across) : meeting.across;
    pair.point = meeting.on_skeleton;
    for (const Vec3& face : meeting.faces)
        if (face.dot(pair.normal) < kMinFaceCosine)
            return false;
    const double gap = pair.normal.dot(meeting.on_cloth - meeting.on_skeleton);
    return gap < radius && !(gap < 0.0 && !has_pierced(meeting.on_cloth, pair.normal, -gap));
}

} // namespace toile::collision
