#include "quadrature2d/geodesic_places.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/mesh/topology.h"

namespace toile::test {
namespace {

/// A surface in its plane, triangle by triangle.
struct FlatSurface {
    std::vector<Triangle> triangles;
    std::vector<Mat2> edges;
    int vertex_count = 0;

    std::vector<Place> places() const
    {
        const Topology topology = build_topology(triangles, vertex_count, "surface");
        return geodesic_places(vertex_count, surface_metric(triangles, edges, topology));
    }
};

/// A strip of squares of side `cell`, `columns` long and `rows` high; closed to a tube when `is_tube`.
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
    const std::vector<MetricEdge> ways = surface_metric(square.triangles, square.edges, topology);
    ASSERT_EQ(ways.size(), 6u); // four sides, the edge inside, the other diagonal
    double longest = 0.0;
    for (const MetricEdge& way : ways)
        longest = std::max(longest, way.length);
    EXPECT_NEAR(longest, 2.0 * std::sqrt(2.0), 1e-14);
}

TEST(GeodesicPlaces, KeepTheDistancesOfAFlatSheet)
{
    const std::vector<Place> places = strip(30, 20, 0.01, false).places();
    for (const int i : {0, 7, 30})
        for (const int j : {3, 20}) {
            const double exact = 0.01 * std::hypot(i - 12.0, double(j));
            EXPECT_NEAR((places[j * 31 + i] - places[12]).norm(), exact, 0.15 * exact);
        }
}

TEST(GeodesicPlaces, CloseATubeOnItself)
{
    const std::vector<Place> places = strip(48, 10, 0.01, true).places();
    // Next to each other across the seam, and half way around: no place is far from its neighbours.
    const double step = (places[1] - places[0]).norm();
    EXPECT_LT((places[47] - places[0]).norm(), 2.0 * step);
    EXPECT_GT((places[24] - places[0]).norm(), 8.0 * step);
}

TEST(GeodesicPlaces, PutPiecesFarFromEachOther)
{
    FlatSurface two = strip(4, 4, 0.01, false);
    const size_t triangles = two.triangles.size();
    for (size_t t = 0; t < triangles; ++t) {
        two.triangles.push_back(
            {25 + two.triangles[t][0], 25 + two.triangles[t][1], 25 + two.triangles[t][2]});
        two.edges.push_back(two.edges[t]);
    }
    two.vertex_count = 51; // and a vertex without triangles
    const std::vector<Place> places = two.places();
    EXPECT_GT((places[25] - places[0]).norm(), 1.0);
    EXPECT_GT((places[50] - places[0]).norm(), 1.0);
    EXPECT_TRUE(places[50].allFinite());
    EXPECT_NEAR((places[24] - places[0]).norm(), (places[49] - places[25]).norm(), 1e-9);
}

} // namespace
} // namespace toile::test
