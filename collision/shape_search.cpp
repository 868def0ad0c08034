#include <algorithm>
#include <cmath>

#include "collision/distance.h"
#include "collision/find_pairs.h"
#include "collision/shape_search.h"

namespace toile {

namespace {

/// How much nearer than its vertices [m] a face or edge must come to a round shape to make a pair of its own.
/// Normally well below the contact thickness, so that cloth that is fine enough keeps to vertex pairs.
constexpr double kSag = 1e-4;

/// Least cos between a pair's normal and the faces beside a sharp corner or edge [-]. Negative, so that a
/// sheet which lies nearly flat on a face still meets all its corners; above -0.408, so that the side on
/// which the solid lies is certain.
constexpr double kLeaningCosine = -0.4;

/// Slope of a sheet over a sharp feature's flank up to which what has sunk behind the feature, and so beside
/// the flank, still counts as inside [-].
constexpr double kInsideSlope = 0.1;

} // namespace

/// A point of the cloth that is nearest to a corner or edge of the skeleton.
struct ShapeSearch::Meeting {
    std::array<int, 4> vertex;
    std::array<double, 4> weight;
    Vec3 on_cloth;               ///< [m]
    Vec3 on_skeleton;            ///< [m]
    Vec3 across;                 ///< unit, along their connection, also where that has no length
    std::span<const Vec3> faces; ///< beside the skeleton's feature
    ContactKind kind;
    int feature;
};

ShapeSearch::ShapeSearch(const SurfaceProximity& cloth, View<const Vec3> x, const ShapeCollider& shape,
                         const Skeleton& skeleton, int collider, double radius)
    : triangles_(cloth.triangles()), edges_(cloth.edges()), x_(x), shape_(shape), skeleton_(skeleton),
      collider_(collider), radius_(radius), distance_(x.size())
{
    parallel_for(kCpu, "collision/shape_distance", x.size(),
                 [&](int v) { distance_[v] = skeleton_.distance(x_[v]); });
}

void ShapeSearch::find_faces(std::vector<ContactPair>& out) const
{
    parallel_append(
        kCpu, "collision/shape_faces", triangles_.size(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int t = begin; t < end; ++t)
                add_face(t, pairs);
        },
        out);
}

void ShapeSearch::find_edges(std::vector<ContactPair>& out) const
{
    parallel_append(
        kCpu, "collision/shape_edges", edges_.edge_count(),
        [&](int begin, int end, std::vector<ContactPair>& pairs) {
            for (int e = begin; e < end; ++e) {
                const std::array<int, 2>& ends = edges_.vertex[e];
                if (!is_worth_testing(ends, (x_[ends[1]] - x_[ends[0]]).norm()))
                    continue;
                for (int k = 0; k < int(skeleton_.corners.size()); ++k)
                    add_corner_edge(e, k, pairs);
                for (int k = 0; k < int(skeleton_.edges.size()); ++k)
                    add_edge_edge(e, k, pairs);
            }
        },
        out);
}

/// False where a face or edge of the given vertices can make no pair: too far away, or too small for a round
/// shape to press between its vertices (a place in a triangle is at most longest / sqrt(3) from a vertex).
bool ShapeSearch::is_worth_testing(std::span<const int> vertices, double longest) const
{
    if (skeleton_.is_round() && longest * longest < 6.0 * skeleton_.radius * kSag)
        return false;
    return std::any_of(vertices.begin(), vertices.end(),
                       [&](int v) { return distance_[v] - longest < radius_; });
}

void ShapeSearch::add_face(int t, std::vector<ContactPair>& out) const
{
    const Triangle& corner = triangles_[t];
    const Vec3 &a = x_[corner[0]], &b = x_[corner[1]], &c = x_[corner[2]];
    const double longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    if (!is_worth_testing({corner.data(), 3}, longest))
        return;
    const Vec3 across = (b - a).cross(c - a);
    if (!(across.norm() > 0.0))
        return;
    const double reach = longest + skeleton_.radius + radius_;
    for (size_t k = 0; k < skeleton_.corners.size(); ++k) {
        const Vec3& p = skeleton_.corners[k].point;
        if ((p - a).squaredNorm() > reach * reach)
            continue;
        const ClosestOnTriangle at = closest_on_triangle(p, a, b, c);
        if (at.feature == TriangleFeature::kFace)
            add({.vertex = contact_vertices(corner[0], corner[1], corner[2]),
                 .weight = {at.barycentric[0], at.barycentric[1], at.barycentric[2]},
                 .on_cloth = at.point,
                 .on_skeleton = p,
                 .across = across.normalized(),
                 .faces = skeleton_.corners[k].faces,
                 .kind = ContactKind::kFaceShape,
                 .feature = int(k)},
                out);
    }
}

/// True when no face beside the edge comes nearer to p than the edge does.
bool ShapeSearch::is_nearest_of_its_faces(int edge, const Vec3& p) const
{
    const View<const int> faces = edges_.triangles.of(edge);
    return std::all_of(faces.begin(), faces.end(), [&](int t) {
        const Triangle& corner = triangles_[t];
        const int k = edge_of(closest_on_triangle(p, x_[corner[0]], x_[corner[1]], x_[corner[2]]).feature);
        return k >= 0 && edges_.triangle_edge[t][k] == edge;
    });
}

void ShapeSearch::add_corner_edge(int e, int corner, std::vector<ContactPair>& out) const
{
    const std::array<int, 2>& end = edges_.vertex[e];
    const Vec3 &a = x_[end[0]], &b = x_[end[1]], &p = skeleton_.corners[corner].point;
    const double s = closest_on_segment(p, a, b);
    const Vec3 on_cloth = a + s * (b - a);
    const double distance = (on_cloth - p).norm();
    if (s <= 0.0 || s >= 1.0 || distance < kTouching || distance > skeleton_.radius + radius_ ||
        !is_nearest_of_its_faces(e, p))
        return;
    add({.vertex = contact_vertices(end[0], end[1]),
         .weight = {1.0 - s, s},
         .on_cloth = on_cloth,
         .on_skeleton = p,
         .across = (on_cloth - p) / distance,
         .faces = skeleton_.corners[corner].faces,
         .kind = ContactKind::kEdgeShape,
         .feature = corner},
        out);
}

void ShapeSearch::add_edge_edge(int e, int edge, std::vector<ContactPair>& out) const
{
    const std::array<int, 2>& end = edges_.vertex[e];
    const Vec3 &a0 = x_[end[0]], &a1 = x_[end[1]];
    const Skeleton::Edge& ridge = skeleton_.edges[edge];
    const ClosestOnSegments at = closest_on_segments(a0, a1, ridge.a, ridge.b);
    const Vec3 da = a1 - a0, db = ridge.b - ridge.a, across = da.cross(db);
    if (!(at.s > 0.0 && at.s < 1.0 && at.t > 0.0 && at.t < 1.0) ||
        !(across.squaredNorm() > kParallelSine2 * da.squaredNorm() * db.squaredNorm()))
        return;
    add({.vertex = contact_vertices(end[0], end[1]),
         .weight = {1.0 - at.s, at.s},
         .on_cloth = a0 + at.s * da,
         .on_skeleton = ridge.a + at.t * db,
         .across = across.normalized(),
         .faces = ridge.faces,
         .kind = ContactKind::kEdgeShape,
         .feature = int(skeleton_.corners.size()) + edge},
        out);
}

void ShapeSearch::add(const Meeting& meeting, std::vector<ContactPair>& out) const
{
    if (skeleton_.is_round())
        add_round(meeting, out);
    else
        add_sharp(meeting, out);
}

/// Pushes away from the skeleton, where the cloth is noticeably nearer than its vertices.
void ShapeSearch::add_round(const Meeting& meeting, std::vector<ContactPair>& out) const
{
    const Vec3 offset = meeting.on_cloth - meeting.on_skeleton;
    const double distance = offset.norm() - skeleton_.radius;
    double at_vertices = distance_[meeting.vertex[0]];
    for (int k = 1; k < 3 && meeting.vertex[k] >= 0; ++k)
        at_vertices = std::min(at_vertices, distance_[meeting.vertex[k]]);
    if (distance >= radius_ || distance > at_vertices - kSag)
        return;
    const Vec3 normal = offset.norm() > kTouching ? Vec3(offset.normalized()) : meeting.across;
    push(meeting, normal, meeting.on_skeleton + skeleton_.radius * normal, out);
}

/// True when the cloth at c, `depth` behind a sharp feature with outward normal n, is pierced by that
/// feature: it is inside the solid, and not past its middle, from where the other side is the way out.
bool ShapeSearch::has_pierced(const Vec3& c, const Vec3& n, double depth) const
{
    return n.dot(c - shape_.pose().translation()) > 0.0 &&
           shape_.closest(c).signed_distance <= kInsideSlope * depth;
}

/// Pushes to the side where the solid is not, when the cloth is in front of the feature or inside behind it.
void ShapeSearch::add_sharp(const Meeting& meeting, std::vector<ContactPair>& out) const
{
    Vec3 outwards = Vec3::Zero();
    for (const Vec3& face : meeting.faces)
        outwards += face;
    const Vec3 normal = meeting.across.dot(outwards) < 0.0 ? Vec3(-meeting.across) : meeting.across;
    const bool leans_too_far = std::any_of(meeting.faces.begin(), meeting.faces.end(), [&](const Vec3& face) {
        return face.dot(normal) < kLeaningCosine;
    });
    const double gap = normal.dot(meeting.on_cloth - meeting.on_skeleton);
    if (leans_too_far || gap >= radius_)
        return;
    if (gap < 0.0 && !has_pierced(meeting.on_cloth, normal, -gap))
        return;
    push(meeting, normal, meeting.on_skeleton, out);
}

void ShapeSearch::push(const Meeting& meeting, const Vec3& normal, const Vec3& point,
                       std::vector<ContactPair>& out) const
{
    out.push_back({.vertex = meeting.vertex,
                   .weight = meeting.weight,
                   .normal = normal,
                   .point = point,
                   .motion = shape_.motion(point),
                   .collider = collider_,
                   .kind = meeting.kind,
                   .feature = meeting.feature});
}

} // namespace toile
