#include "collision/surface_proximity.h"

#include <algorithm>
#include <utility>

#include "collision/triangle_tree.h"

namespace toile {

namespace {

/// Two closest points nearer than this [m] are the same one, reached through neighbouring triangles.
constexpr double kSamePoint = 1e-9;

struct NearTriangle {
    int triangle;
    ClosestOnTriangle closest;
};

Vec3 unit_or_zero(const Vec3& v)
{
    const double length = v.norm();
    return length > 1e-12 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

} // namespace

/// What moves, and what can be asked of one feature.
class SurfaceProximity::Surface {
public:
    Surface(View<const Triangle> triangles, View<const Vec3> positions);
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void move(View<const Vec3> positions);

    const Vec3& corner(int t, int k) const { return positions[size_t(triangles[size_t(t)][k])]; }
    ClosestOnTriangle closest_on(int t, const Vec3& p) const
    {
        return closest_on_triangle(p, corner(t, 0), corner(t, 1), corner(t, 2));
    }
    // Computed when asked for: a refit touches every feature, the queries that follow touch few.
    Vec3 face_normal(int t) const;
    Vec3 edge_normal(int e) const;
    Vec3 vertex_normal(int v) const;

    SurfacePoint surface_point(const NearTriangle& near, const Vec3& p) const;
    bool is_local_minimum(const NearTriangle& near, const Vec3& p) const;

    std::vector<Triangle> triangles;
    std::vector<Vec3> positions;
    SurfaceEdges edges;
    TriangleTree tree; ///< at positions
};

SurfaceProximity::Surface::Surface(View<const Triangle> triangle_list, View<const Vec3> start)
    : triangles(triangle_list.begin(), triangle_list.end()), positions(start.begin(), start.end()),
      edges(build_surface_edges(triangle_list, start.size()))
{
    tree.build(triangles, positions);
}

void SurfaceProximity::Surface::move(View<const Vec3> new_positions)
{
    positions.assign(new_positions.begin(), new_positions.end());
    tree.refit(positions);
}

Vec3 SurfaceProximity::Surface::face_normal(int t) const
{
    const Vec3 doubled_area = (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
    const double length = doubled_area.norm();
    return length > 0.0 ? Vec3(doubled_area / length) : Vec3(Vec3::Zero());
}

Vec3 SurfaceProximity::Surface::edge_normal(int e) const
{
    Vec3 sum = Vec3::Zero();
    for (const int t : edges.triangles.of(e))
        sum += face_normal(t);
    return unit_or_zero(sum);
}

Vec3 SurfaceProximity::Surface::vertex_normal(int v) const
{
    Vec3 sum = Vec3::Zero();
    for (const int corner : edges.corners_of_vertex.of(v)) {
        const int t = corner / 3;
        const Vec3& x = positions[v];
        const Vec3 next = this->corner(t, (corner + 1) % 3) - x;
        const Vec3 previous = this->corner(t, (corner + 2) % 3) - x;
        sum += std::atan2(next.cross(previous).norm(), next.dot(previous)) * face_normal(t);
    }
    return unit_or_zero(sum);
}

SurfacePoint SurfaceProximity::Surface::surface_point(const NearTriangle& near, const Vec3& p) const
{
    const int t = near.triangle;
    const ClosestOnTriangle& closest = near.closest;
    SurfacePoint result{t, closest.feature, closest.barycentric, closest.point, face_normal(t), 0.0};
    if (const int k = edge_of(closest.feature); k >= 0)
        result.normal = edge_normal(edges.triangle_edge[t][k]);
    else if (const int v = vertex_of(closest.feature); v >= 0)
        result.normal = vertex_normal(triangles[t][v]);

    // A feature without a normal: its own face's, else towards p, else up.
    const double distance = std::sqrt(closest.distance2);
    if (result.normal.isZero(0.0))
        result.normal = face_normal(t);
    if (result.normal.isZero(0.0))
        result.normal = distance > 0.0 ? Vec3((p - closest.point) / distance) : Vec3(Vec3::UnitY());
    result.signed_distance = result.normal.dot(p - closest.point) < 0.0 ? -distance : distance;
    return result;
}

/// True when no triangle that shares the closest point's edge or vertex comes nearer to the query point.
/// A sharing triangle comes nearer exactly when one of its edges out of the closest point leads nearer: its
/// angle there is below 180 degrees, so no direction between them can do what neither of them does.
bool SurfaceProximity::Surface::is_local_minimum(const NearTriangle& near, const Vec3& p) const
{
    constexpr double kAngleSlack = 1e-9;     // [-]
    constexpr double kPositionSlack = 1e-14; // [m] rounding of coordinates of a few metres
    const Vec3 towards_p = p - near.closest.point;
    const double slack = kAngleSlack * towards_p.norm() + kPositionSlack;
    const auto leads_nearer = [&](const Vec3& x) {
        const Vec3 step = x - near.closest.point;
        return towards_p.dot(step) > slack * step.norm();
    };
    const int t = near.triangle;
    if (const int k = edge_of(near.closest.feature); k >= 0) {
        const View<const int> sharing = edges.triangles.of(edges.triangle_edge[t][k]);
        return std::none_of(sharing.begin(), sharing.end(), [&](int other) {
            return leads_nearer(corner(other, 0)) || leads_nearer(corner(other, 1)) ||
                   leads_nearer(corner(other, 2));
        });
    }
    if (const int k = vertex_of(near.closest.feature); k >= 0) {
        const View<const int> sharing = edges.corners_of_vertex.of(triangles[t][k]);
        return std::none_of(sharing.begin(), sharing.end(), [&](int own) {
            return leads_nearer(corner(own / 3, (own + 1) % 3)) ||
                   leads_nearer(corner(own / 3, (own + 2) % 3));
        });
    }
    return true;
}

SurfaceProximity::SurfaceProximity(View<const Triangle> triangles, View<const Vec3> positions)
    : surface_(std::make_unique<Surface>(triangles, positions))
{
}
SurfaceProximity::~SurfaceProximity() = default;
SurfaceProximity::SurfaceProximity(SurfaceProximity&&) noexcept = default;
SurfaceProximity& SurfaceProximity::operator=(SurfaceProximity&&) noexcept = default;

void SurfaceProximity::update(View<const Vec3> positions) { surface_->move(positions); }

std::optional<SurfacePoint> SurfaceProximity::closest(const Vec3& p, double max_distance, int hint) const
{
    NearTriangle best{-1, {}};
    best.closest.distance2 = max_distance * max_distance;
    double best_distance = max_distance;
    const auto try_triangle = [&](int t) {
        const ClosestOnTriangle candidate = surface_->closest_on(t, p);
        if (candidate.distance2 > best.closest.distance2 ||
            (candidate.distance2 == best.closest.distance2 && (best.triangle < 0 || t >= best.triangle)))
            return -1.0;
        best = {t, candidate};
        best_distance = std::sqrt(candidate.distance2);
        return best_distance;
    };
    if (hint >= 0)
        try_triangle(hint);
    surface_->tree.visit_nearest(p, best_distance, try_triangle);
    if (best.triangle < 0)
        return std::nullopt;
    return surface_->surface_point(best, p);
}

SurfacePoint SurfaceProximity::closest_from(const Vec3& p, int triangle) const
{
    NearTriangle best{triangle, surface_->closest_on(triangle, p)};
    for (int last = -1; last != best.triangle;) {
        last = best.triangle;
        const auto try_triangle = [&](int t) {
            const ClosestOnTriangle candidate = surface_->closest_on(t, p);
            if (candidate.distance2 < best.closest.distance2)
                best = {t, candidate};
        };
        // Only triangles at the closest point can be nearer.
        const TriangleFeature feature = best.closest.feature;
        if (const int k = edge_of(feature); k >= 0)
            for (const int t : surface_->edges.triangles.of(surface_->edges.triangle_edge[last][k]))
                try_triangle(t);
        else if (const int c = vertex_of(feature); c >= 0)
            for (const int corner : surface_->edges.corners_of_vertex.of(surface_->triangles[last][c]))
                try_triangle(corner / 3);
    }
    return surface_->surface_point(best, p);
}

void SurfaceProximity::local_closest(const Vec3& p, double radius, std::vector<SurfacePoint>& out,
                                     const Vec3& unlike) const
{
    out.clear();
    surface_->tree.visit_within(p, radius, unlike, kUnlikeCosine, [&](int t) {
        const NearTriangle near{t, surface_->closest_on(t, p)};
        if (near.closest.distance2 <= radius * radius &&
            surface_->face_normal(t).dot(unlike) <= kUnlikeCosine && surface_->is_local_minimum(near, p))
            out.push_back(surface_->surface_point(near, p));
    });
    std::sort(out.begin(), out.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
        return std::pair(a.distance(), a.triangle) < std::pair(b.distance(), b.triangle);
    });

    // Neighbours that meet at the same point: keep the first.
    size_t kept = 0;
    for (const SurfacePoint& candidate : out) {
        const auto same = [&](const SurfacePoint& other) {
            return (candidate.point - other.point).squaredNorm() < kSamePoint * kSamePoint;
        };
        if (std::none_of(out.begin(), out.begin() + long(kept), same))
            out[kept++] = candidate;
    }
    out.resize(kept);
}

void SurfaceProximity::triangles_within(const Vec3& p, double radius, std::vector<int>& out) const
{
    out.clear();
    surface_->tree.visit_within(p, radius, Vec3::Zero(), kUnlikeCosine, [&](int t) {
        if (surface_->closest_on(t, p).distance2 <= radius * radius)
            out.push_back(t);
    });
    std::sort(out.begin(), out.end());
}

void SurfaceProximity::triangles_maybe_around(const Vec3& a, const Vec3& b, double radius,
                                              std::vector<int>& out) const
{
    out.clear();
    surface_->tree.visit_around(a, b, radius, [&](int t) { out.push_back(t); });
}

View<const Triangle> SurfaceProximity::triangles() const { return surface_->triangles; }
View<const Vec3> SurfaceProximity::positions() const { return surface_->positions; }
Vec3 SurfaceProximity::edge_normal(int edge) const { return surface_->edge_normal(edge); }
Vec3 SurfaceProximity::vertex_normal(int vertex) const { return surface_->vertex_normal(vertex); }
Vec3 SurfaceProximity::face_normal(int triangle) const { return surface_->face_normal(triangle); }
const SurfaceEdges& SurfaceProximity::edges() const { return surface_->edges; }

} // namespace toile
