#include "collision/untangle/piercings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "collision/surface_proximity.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Distance [-] over the edge's length between the two ways to compute where it goes through the triangle,
/// beyond which neither means anything: the edge lies in the triangle's plane.
constexpr double kMaxMismatch = 1e-4;

/// Six times the signed volume of tetrahedron (a, b, c, d).
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// Where segment p q goes through triangle (a, b, c): by the signs of five volumes.
std::optional<Piercing> pierce(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c)
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
    Piercing piercing;
    piercing.s = above / (above - below);
    piercing.barycentric = Vec3(wa, wb, wc) / sum;
    piercing.point = p + piercing.s * (q - p);
    const Vec3& w = piercing.barycentric;
    const double mismatch = (w[0] * a + w[1] * b + w[2] * c - piercing.point).squaredNorm();
    if (!(mismatch <= kMaxMismatch * kMaxMismatch * (q - p).squaredNorm()))
        return std::nullopt;
    return piercing;
}

bool share_a_vertex(const std::array<int, 2>& edge, const Triangle& corner)
{
    return std::any_of(corner.begin(), corner.end(), [&](int v) { return v == edge[0] || v == edge[1]; });
}

} // namespace

std::vector<Piercing> find_piercings(const JoinedCloths& cloths, View<const Vec3> x)
{
    const SurfaceProximity surface(cloths.triangles, x);
    std::vector<Piercing> piercings;
    const auto find = [&](int begin, int end, std::vector<Piercing>& found) {
        std::vector<int> near;
        for (int e = begin; e < end; ++e) {
            const std::array<int, 2>& edge = cloths.edges.vertex[e];
            const Vec3 &p = x[edge[0]], &q = x[edge[1]];
            surface.triangles_maybe_around(p, q, 0.0, near);
            std::sort(near.begin(), near.end());
            for (const int t : near) {
                const Triangle& corner = cloths.triangles[t];
                if (share_a_vertex(edge, corner))
                    continue;
                std::optional<Piercing> piercing = pierce(p, q, x[corner[0]], x[corner[1]], x[corner[2]]);
                if (!piercing)
                    continue;
                piercing->edge = e;
                piercing->triangle = t;
                found.push_back(*piercing);
            }
        }
    };
    parallel_append(kCpu, "untangle/piercings", cloths.edges.edge_count(), find, piercings);
    return piercings;
}

} // namespace toile
