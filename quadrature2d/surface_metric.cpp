#include "quadrature2d/surface_metric.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::quadrature2d {

namespace {

/// Corner of a triangle opposite an edge, in the edge's frame: along it from its first end, and
/// perpendicular.
struct Apex {
    double length = 0.0;              ///< of the edge [m]
    double along = 0.0, beside = 0.0; ///< [m]
};

Apex apex_of(const Triangle& corner, const Mat2& rest_edges, const Edge& edge)
{
    const std::array<Vec2, 3> at{Vec2::Zero(), rest_edges.col(0), rest_edges.col(1)};
    const auto position = [&](int v) {
        return at[std::find(corner.begin(), corner.end(), v) - corner.begin()];
    };
    const int opposite = corner[0] + corner[1] + corner[2] - edge.vertex[0] - edge.vertex[1];
    const Vec2 side = position(edge.vertex[1]) - position(edge.vertex[0]);
    const Vec2 away = position(opposite) - position(edge.vertex[0]);
    Apex apex;
    apex.length = side.norm();
    apex.along = away.dot(side) / apex.length;
    apex.beside = std::sqrt(std::max(away.squaredNorm() - apex.along * apex.along, 0.0));
    return apex;
}

} // namespace

std::vector<MetricEdge> surface_metric(View<const Triangle> triangles, View<const Mat2> rest_edges,
                                       const Topology& topology)
{
    std::vector<MetricEdge> metric;
    for (const Edge& edge : topology.edges) {
        const auto apex = [&](int side) {
            return apex_of(triangles[edge.triangle[side]], rest_edges[edge.triangle[side]], edge);
        };
        const Apex left = apex(0);
        metric.push_back({edge.vertex[0], edge.vertex[1], left.length});
        if (edge.is_border())
            continue;
        const Apex right = apex(1);
        const double height = left.beside + right.beside;
        const double crossing = left.along + (right.along - left.along) * left.beside / height;
        if (crossing > 0.0 && crossing < left.length)
            metric.push_back(
                {edge.opposite[0], edge.opposite[1], std::hypot(height, right.along - left.along)});
    }
    return metric;
}

} // namespace toile::quadrature2d
