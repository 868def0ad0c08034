#include "collision/repair/contour_minimization.h"

#include <cmath>

#include <Eigen/Geometry>

namespace toile::collision {

namespace {

/// Slope |E . N| below which an edge counts as lying in the triangle [-]: its displacement out of the
/// triangle would be unbounded.
constexpr double kMinSlope = 0.05;

Vec3 unit_normal(View<const Vec3> x, const Triangle& corner)
{
    return (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]).normalized();
}

/// True if one of the edge's faces has a corner in the triangle. The curve ends in that corner, and
/// shortening it does not separate the two.
bool meets_in_a_corner(const JoinedCloths& cloths, const EdgeTriangleIntersection& intersection)
{
    const Triangle& corner = cloths.triangles[intersection.triangle];
    for (const int face : cloths.edges.triangles.of(intersection.edge))
        for (const int v : cloths.triangles[face])
            if (v == corner[0] || v == corner[1] || v == corner[2])
                return true;
    return false;
}

/// Direction [-] in which the edge should move relative to the triangle.
Vec3 shortening_direction(const JoinedCloths& cloths, const EdgeTriangleIntersection& intersection,
                          View<const Vec3> x)
{
    const auto [a, b] = cloths.edges.vertex[intersection.edge];
    const Vec3 E = (x[b] - x[a]).normalized();
    const Vec3 N = unit_normal(x, cloths.triangles[intersection.triangle]);
    const double slope = E.dot(N);
    const double safe_slope = std::copysign(std::fmax(std::abs(slope), kMinSlope), slope);
    if (meets_in_a_corner(cloths, intersection)) // the shorter part of the edge goes back to the longer
        return std::copysign(1.0, slope) * (intersection.s < 0.5 ? 1.0 : -1.0) * N;
    Vec3 G = Vec3::Zero();
    for (const int face : cloths.edges.triangles.of(intersection.edge)) {
        const Triangle& corner = cloths.triangles[face];
        Vec3 R = N.cross(unit_normal(x, corner));
        if (!(R.norm() > 0.0))
            continue;
        R.normalize();
        const Vec3 into = (x[corner[0]] + x[corner[1]] + x[corner[2]]) / 3.0 - x[a];
        if (R.dot(into - E.dot(into) * E) < 0.0)
            R = -R;
        G += R - 2.0 * E.dot(R) / safe_slope * N;
    }
    return G;
}

} // namespace

void shorten_contours(const JoinedCloths& cloths, const std::vector<EdgeTriangleIntersection>& intersections,
                      double step, View<Vec3> x)
{
    std::vector<Vec3> sum(x.size(), Vec3::Zero());
    std::vector<double> weight(x.size(), 0.0);
    for (const EdgeTriangleIntersection& intersection : intersections) {
        const Vec3 G = shortening_direction(cloths, intersection, x);
        if (!G.allFinite())
            continue;
        const Vec3 relative = step / std::sqrt(G.squaredNorm() + 1.0) * G;
        const auto [a, b] = cloths.edges.vertex[intersection.edge];
        const Triangle& corner = cloths.triangles[intersection.triangle];
        const int vertex[5] = {a, b, corner[0], corner[1], corner[2]};
        const double coefficient[5] = {1.0 - intersection.s, intersection.s, -intersection.barycentric[0],
                                       -intersection.barycentric[1], -intersection.barycentric[2]};
        double total = 0.0;
        for (int k = 0; k < 5; ++k)
            if (cloths.fixed[vertex[k]] == 0)
                total += coefficient[k] * coefficient[k];
        for (int k = 0; k < 5 && total > 0.0; ++k)
            if (cloths.fixed[vertex[k]] == 0) {
                sum[vertex[k]] += std::abs(coefficient[k]) * coefficient[k] / total * relative;
                weight[vertex[k]] += std::abs(coefficient[k]);
            }
    }
    for (int v = 0; v < x.size(); ++v)
        if (weight[v] > 0.0)
            x[v] += sum[v] / weight[v];
}

} // namespace toile::collision
