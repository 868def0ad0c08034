#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "core/mesh/topology.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {

namespace {

struct Expected {
    int pieces, border_loops, euler_characteristic;
};

void expect_shape(const std::vector<Triangle>& triangles, const Expected& expected)
{
    const SurfaceTopology topology = surface_topology(triangles);
    EXPECT_EQ(topology.pieces, expected.pieces);
    EXPECT_EQ(topology.border_loops, expected.border_loops);
    EXPECT_EQ(topology.euler_characteristic, expected.euler_characteristic);
    EXPECT_TRUE(topology.is_manifold());
}

/// Sheet of n x m squares in two triangles each; its columns, and its rows, may close to a ring.
std::vector<Triangle> sheet(int n, int m, bool closes_n, bool closes_m)
{
    const int rows = closes_m ? m : m + 1, columns = closes_n ? n : n + 1;
    const auto vertex = [&](int i, int k) { return (i % columns) * rows + k % rows; };
    std::vector<Triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < m; ++k) {
            triangles.emplace_back(vertex(i, k), vertex(i + 1, k), vertex(i + 1, k + 1));
            triangles.emplace_back(vertex(i, k), vertex(i + 1, k + 1), vertex(i, k + 1));
        }
    return triangles;
}

TEST(SurfaceTopology, KnowsDiscTubeTorusAndSphere)
{
    expect_shape(sheet(4, 3, false, false), {1, 1, 1});
    expect_shape(sheet(4, 3, true, false), {1, 2, 0});
    expect_shape(sheet(4, 3, true, true), {1, 0, 0});
    expect_shape(subdivide(tetrahedron(), 3).triangles, {1, 0, 2});
    expect_shape({}, {0, 0, 0});
}

TEST(SurfaceTopology, CountsPiecesAndHoles)
{
    // Two sheets, one of them without a triangle in its middle.
    std::vector<Triangle> triangles = sheet(5, 5, false, false);
    for (const Triangle& t : sheet(6, 6, false, false))
        triangles.push_back(t + Triangle::Constant(100));
    triangles.erase(triangles.begin() + 24);
    expect_shape(triangles, {2, 3, 1});
}

TEST(SurfaceTopology, IgnoresWindingsAndUnusedVertices)
{
    std::vector<Triangle> triangles = sheet(7, 4, true, false);
    for (size_t t = 0; t < triangles.size(); t += 3)
        std::swap(triangles[t][0], triangles[t][1]);
    for (Triangle& t : triangles)
        t = 3 * t + Triangle::Constant(5);
    expect_shape(triangles, {1, 2, 0});
}

TEST(SurfaceTopology, KeepsPiecesThatTouchInAPointApart)
{
    const SurfaceTopology topology = surface_topology(std::vector<Triangle>{{0, 1, 2}, {0, 3, 4}});
    EXPECT_EQ(topology.pieces, 2);
    EXPECT_EQ(topology.border_loops, 2);
    EXPECT_EQ(topology.euler_characteristic, 1);
}

TEST(SurfaceTopology, NamesWhatIsNotManifold)
{
    // A pocket on a sheet: three triangles at an edge belong to one piece.
    const SurfaceTopology branching =
        surface_topology(std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
    EXPECT_EQ(branching.non_manifold_edges, (std::vector<std::array<int, 2>>{{0, 1}}));
    EXPECT_EQ(branching.pieces, 1);
    EXPECT_FALSE(branching.is_manifold());

    const SurfaceTopology repeated = surface_topology(std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}});
    EXPECT_EQ(repeated.duplicate_triangles, std::vector{1});
    EXPECT_FALSE(repeated.is_manifold());

    const SurfaceTopology collapsed = surface_topology(std::vector<Triangle>{{7, 7, 2}, {0, 1, 2}});
    EXPECT_EQ(collapsed.collapsed_triangles, std::vector{0});
    EXPECT_EQ(collapsed.pieces, 1);
    EXPECT_EQ(collapsed.border_loops, 1);
    EXPECT_EQ(collapsed.euler_characteristic, 1);
}

/// Borders are walked to their end, whatever meets there.
TEST(SurfaceTopology, EndsForAnyTriangles)
{
    std::mt19937 random(3);
    for (int round = 0; round < 2000; ++round) {
        std::vector<Triangle> triangles;
        for (int t = 0; t < 1 + round % 12; ++t)
            triangles.emplace_back(int(random() % 5), int(random() % 5), int(random() % 5));
        const SurfaceTopology topology = surface_topology(triangles);
        EXPECT_LE(topology.pieces + int(topology.collapsed_triangles.size()), int(triangles.size()));
        EXPECT_LE(topology.border_loops, 3 * int(triangles.size()));
    }
}

} // namespace
} // namespace toile::test
