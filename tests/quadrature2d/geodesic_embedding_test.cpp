#include "quadrature2d/geodesic_embedding.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/topology.h"

namespace toile::test {

using namespace quadrature2d;

namespace {

/// Plane surface, triangle by triangle.
struct FlatSurface {
    std::vector<Triangle> triangles;
    std::vector<Mat2> edges;
    int vertex_count = 0;

    std::vector<EmbeddedPoint> points() const
    {
        const Topology topology = build_topology(triangles, vertex_count, "surface");
        return geodesic_embedding(vertex_count, surface_metric(triangles, edges, topology));
    }
};

/// Strip of squares of side `cell`, `columns` long and `rows` high; closed to a tube if `is_tube`.
FlatSurface strip(int columns, int rows, double cell, bool is_tube)
{
    const int across = is_tube ? columns : columns + 1;
    FlatSurface surface;
    surface.vertex_count = across * (rows + 1);
    const auto vertex = [&](int i, int j) { return j * across + i % across; };
    const auto add = [&](const Triangle& corners, const Vec2& first, const Vec2& second) {
        surface.triangles.push_back(corners);
        surface.edges.emplace_back();
        surface.edges.back() << cell * first, cell * second;
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            add({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)}, Vec2(1, 0), Vec2(1, 1));
            add({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)}, Vec2(1, 1), Vec2(0, 1));
        }
    return surface;
}

TEST(SurfaceMetric, AddsTheDiagonalsThatStayInside)
{
    const FlatSurface square = strip(1, 1, 2.0, false);
    const Topology topology = build_topology(square.triangles, 4, "square");
    const std::vector<MetricEdge> metric = surface_metric(square.triangles, square.edges, topology);
    ASSERT_EQ(metric.size(), 6u); // four sides, the edge inside, the other diagonal
    double longest = 0.0;
    for (const MetricEdge& edge : metric)
        longest = std::max(longest, edge.length);
    EXPECT_NEAR(longest, 2.0 * std::sqrt(2.0), 1e-14);
}

TEST(GeodesicEmbedding, KeepTheDistancesOfAFlatSheet)
{
    const std::vector<EmbeddedPoint> points = strip(30, 20, 0.01, false).points();
    for (const int i : {0, 7, 30})
        for (const int j : {3, 20}) {
            const double exact = 0.01 * std::hypot(i - 12.0, double(j));
            EXPECT_NEAR((points[j * 31 + i] - points[12]).norm(), exact, 0.15 * exact);
        }
}

TEST(GeodesicEmbedding, CloseATubeOnItself)
{
    const std::vector<EmbeddedPoint> points = strip(48, 10, 0.01, true).points();
    // Adjacent across the seam, and on the opposite side: no embedded point is far from its neighbours.
    const double step = (points[1] - points[0]).norm();
    EXPECT_LT((points[47] - points[0]).norm(), 2.0 * step);
    EXPECT_GT((points[24] - points[0]).norm(), 8.0 * step);
}

TEST(GeodesicEmbedding, PutPiecesFarFromEachOther)
{
    FlatSurface two = strip(4, 4, 0.01, false);
    const size_t triangles = two.triangles.size();
    for (size_t t = 0; t < triangles; ++t) {
        two.triangles.push_back(
            {25 + two.triangles[t][0], 25 + two.triangles[t][1], 25 + two.triangles[t][2]});
        two.edges.push_back(two.edges[t]);
    }
    two.vertex_count = 51; // and a vertex without triangles
    const std::vector<EmbeddedPoint> points = two.points();
    EXPECT_GT((points[25] - points[0]).norm(), 1.0);
    EXPECT_GT((points[50] - points[0]).norm(), 1.0);
    EXPECT_TRUE(points[50].allFinite());
    EXPECT_NEAR((points[24] - points[0]).norm(), (points[49] - points[25]).norm(), 1e-9);
}

} // namespace
} // namespace toile::test
