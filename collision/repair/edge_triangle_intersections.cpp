#include "collision/repair/edge_triangle_intersections.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "collision/geometry/surface_proximity.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Mismatch, over the edge's length [-], between two computations of the intersection point beyond which
/// neither is reliable: the edge lies in the triangle's plane.
constexpr double kMaxMismatch = 1e-4;

/// Six times the signed volume of tetrahedron (a, b, c, d).
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// Intersection of segment p q with triangle (a, b, c), by the signs of five volumes.
std::optional<EdgeTriangleIntersection> intersect(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                  const Vec3& c)
{
    const double above = volume(a, b, c, p), below = volume(a, b, c, q);
    if ((above > 0.0) == (below > 0.0))
        return std::nullopt;
    const double wa = volume(p, q, b, c), wb = volume(p, q, c, a), wc = volume(p, q, a, b);
    if (!((wa >= 0.0 && wb >= 0.0 && wc >= 0.0) || (wa <= 0.0 && wb <= 0.0 && wc <= 0.0)))
        return std::nullopt;
    const double sum = wa + wb + wc;
    if (sum == 0.0)
        return std::nullopt;
    EdgeTriangleIntersection intersection;
    intersection.s = above / (above - below);
    intersection.barycentric = Vec3(wa, wb, wc) / sum;
    intersection.point = p + intersection.s * (q - p);
    const Vec3& w = intersection.barycentric;
    const double mismatch = (w[0] * a + w[1] * b + w[2] * c - intersection.point).squaredNorm();
    if (!(mismatch <= kMaxMismatch * kMaxMismatch * (q - p).squaredNorm()))
        return std::nullopt;
    return intersection;
}

bool share_a_vertex(const std::array<int, 2>& edge, const Triangle& corner)
{
    return std::any_of(corner.begin(), corner.end(), [&](int v) { return v == edge[0] || v == edge[1]; });
}

} // namespace

std::vector<EdgeTriangleIntersection> find_edge_triangle_intersections(const JoinedCloths& cloths,
                                                                       View<const Vec3> x)
{
    const SurfaceProximity surface(cloths.triangles, x);
    std::vector<EdgeTriangleIntersection> intersections;
    const auto find = [&](int begin, int end, std::vector<EdgeTriangleIntersection>& found) {
        std::vector<int> near;
        for (int e = begin; e < end; ++e) {
            const std::array<int, 2>& edge = cloths.edges.vertex[e];
            const Vec3 &p = x[edge[0]], &q = x[edge[1]];
            surface.triangles_maybe_near(p, q, 0.0, near);
            std::sort(near.begin(), near.end());
            for (const int t : near) {
                const Triangle& corner = cloths.triangles[t];
                if (share_a_vertex(edge, corner))
                    continue;
                std::optional<EdgeTriangleIntersection> intersection =
                    intersect(p, q, x[corner[0]], x[corner[1]], x[corner[2]]);
                if (!intersection)
                    continue;
                intersection->edge = e;
                intersection->triangle = t;
                found.push_back(*intersection);
            }
        }
    };
    parallel_append(kCpu, "untangle/edge_triangle_intersections", cloths.edges.edge_count(), find,
                    intersections);
    return intersections;
}

} // namespace toile::collision
