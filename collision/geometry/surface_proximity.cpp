#include "collision/geometry/surface_proximity.h"

#include <algorithm>
#include <utility>

#include "collision/bvh/triangle_tree.h"

namespace toile::collision {

/// State that moves with the surface.
class SurfaceProximity::Surface {
public:
    Surface(View<const Triangle> triangles, View<const Vec3> positions);
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    void move(View<const Vec3> positions);

    std::vector<Triangle> triangles;
    std::vector<Vec3> positions;
    SurfaceEdges edges;
    SurfaceView view;  ///< of the members above
    TriangleTree tree; ///< at positions
};

SurfaceProximity::Surface::Surface(View<const Triangle> triangle_list, View<const Vec3> start)
    : triangles(triangle_list.begin(), triangle_list.end()), positions(start.begin(), start.end()),
      edges(build_surface_edges(triangle_list, start.size())), view{triangles, positions, view_of(edges)}
{
    tree.build(triangles, positions);
}

void SurfaceProximity::Surface::move(View<const Vec3> new_positions)
{
    positions.assign(new_positions.begin(), new_positions.end());
    view.positions = positions;
    tree.refit(positions);
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
    NearTriangle best;
    best.closest.distance2 = max_distance * max_distance;
    double best_distance = max_distance;
    const auto try_triangle = [&](int t) {
        const ClosestOnTriangle candidate = surface_->view.closest_on(t, p);
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
    return surface_->view.surface_point(best, p);
}

SurfacePoint SurfaceProximity::closest_from(const Vec3& p, int triangle) const
{
    return surface_->view.closest_from(p, triangle);
}

void SurfaceProximity::local_closest(const Vec3& p, double radius, std::vector<SurfacePoint>& out,
                                     const Vec3& unlike) const
{
    out.clear();
    surface_->tree.visit_within(p, radius, unlike, kUnlikeCosine, [&](int t) {
        const NearTriangle near{t, surface_->view.closest_on(t, p)};
        if (near.closest.distance2 <= radius * radius &&
            surface_->view.face_normal(t).dot(unlike) <= kUnlikeCosine &&
            surface_->view.is_local_minimum(near, p))
            out.push_back(surface_->view.surface_point(near, p));
    });
    std::sort(out.begin(), out.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
        return std::pair(a.distance(), a.triangle) < std::pair(b.distance(), b.triangle);
    });

    // Coincident points of adjacent triangles: keep the lowest triangle.
    size_t kept = 0;
    for (const SurfacePoint& candidate : out) {
        const auto end = out.begin() + long(kept);
        const auto same = std::find_if(
            out.begin(), end, [&](const SurfacePoint& other) { return candidate.is_at(other.point); });
        if (same == end)
            out[kept++] = candidate;
        else if (candidate.triangle < same->triangle)
            *same = candidate;
    }
    out.resize(kept);
}

void SurfaceProximity::triangles_within(const Vec3& p, double radius, std::vector<int>& out) const
{
    out.clear();
    surface_->tree.visit_within(p, radius, Vec3::Zero(), kUnlikeCosine, [&](int t) {
        if (surface_->view.closest_on(t, p).distance2 <= radius * radius)
            out.push_back(t);
    });
    std::sort(out.begin(), out.end());
}

void SurfaceProximity::triangles_maybe_near(const Vec3& a, const Vec3& b, double radius,
                                            std::vector<int>& out) const
{
    out.clear();
    surface_->tree.visit_near(a, b, radius, [&](int t) { out.push_back(t); });
}

View<const Triangle> SurfaceProximity::triangles() const { return surface_->triangles; }
View<const Vec3> SurfaceProximity::positions() const { return surface_->positions; }
Vec3 SurfaceProximity::edge_normal(int edge) const { return surface_->view.edge_normal(edge); }
Vec3 SurfaceProximity::vertex_normal(int vertex) const { return surface_->view.vertex_normal(vertex); }
Vec3 SurfaceProximity::face_normal(int triangle) const { return surface_->view.face_normal(triangle); }
const SurfaceEdges& SurfaceProximity::edges() const { return surface_->edges; }
const SurfaceView& SurfaceProximity::view() const { return surface_->view; }

} // namespace toile::collision
