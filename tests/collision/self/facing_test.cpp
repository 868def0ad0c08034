#include "collision/self/facing.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

namespace {

struct Sheets {
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;

    /// Adds a grid of side x side vertices from `corner` on, `edge` [m] apart, in the plane of directions u,
    /// v.
    void add(int side, double edge, const Vec3& corner, const Vec3& u = Vec3::UnitX(),
             const Vec3& v = Vec3::UnitZ())
    {
        const int first = int(x.size());
        for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
                x.push_back(corner + edge * (i * u + j * v));
        for (int j = 0; j + 1 < side; ++j)
            for (int i = 0; i + 1 < side; ++i) {
                const int a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
                triangles.emplace_back(a, c, b);
                triangles.emplace_back(b, c, d);
            }
    }
    std::vector<NearPair> facing(double margin) const
    {
        std::vector<NearPair> pairs;
        NearPairs(triangles, x).find(x, {}, margin, pairs);
        std::erase_if(pairs, [](const NearPair& pair) { return !pair.is_facing; });
        return pairs;
    }
};

/// Vertices of nonzero weight of a pair, on both sides: pairs of equal features have equal sets.
std::set<int> features(const NearPair& pair)
{
    std::set<int> points;
    for (int k = 0; k < 4; ++k)
        if (std::abs(pair.weight[k]) > kOffCorner)
            points.insert(pair.vertex[k]);
    return points;
}

void expect_each_once(const std::vector<NearPair>& pairs)
{
    std::set<std::set<int>> seen;
    for (const NearPair& pair : pairs)
        EXPECT_TRUE(seen.insert(features(pair)).second) << pair.vertex[0] << " " << pair.vertex[1];
}

TEST(Facing, EveryVertexBetweenParallelSheetsHasOnePair)
{
    // Shifted: vertices face interior points of triangles.
    Sheets sheets;
    sheets.add(8, 0.01, Vec3(0, 0, 0));
    sheets.add(8, 0.01, Vec3(0.0031, 0.002, 0.0017));
    const std::vector<NearPair> pairs = sheets.facing(0.003);
    expect_each_once(pairs);
    std::vector<int> count(sheets.x.size());
    for (const NearPair& pair : pairs)
        if (!pair.is_edge_edge && pair.distance < 0.00201)
            ++count[pair.vertex[0]];
    for (int j = 1; j < 7; ++j)
        for (int i = 1; i < 7; ++i) {
            EXPECT_EQ(count[8 * j + i], 1);
            EXPECT_EQ(count[64 + 8 * (j - 1) + i - 1], 1);
        }
}

TEST(Facing, EqualSheetsFaceVertexToVertex)
{
    // Vertices lie above vertices, edges above edges: one pair per two vertices, though both meet up to six
    // triangles each.
    Sheets sheets;
    sheets.add(6, 0.01, Vec3(0, 0, 0));
    sheets.add(6, 0.01, Vec3(0, 0.002, 0));
    const std::vector<NearPair> pairs = sheets.facing(0.003);
    expect_each_once(pairs);
    std::vector<int> count(36);
    for (const NearPair& pair : pairs)
        if (!pair.is_edge_edge)
            ++count[pair.vertex[0]];
    EXPECT_TRUE(std::all_of(count.begin(), count.end(), [](int n) { return n == 1; }));
    // No edge pairs remain: parallel edges are covered by their end points.
    EXPECT_TRUE(std::none_of(pairs.begin(), pairs.end(), [&](const NearPair& p) {
        return p.is_edge_edge &&
               std::abs((sheets.x[p.vertex[1]] - sheets.x[p.vertex[0]])
                            .normalized()
                            .dot((sheets.x[p.vertex[3]] - sheets.x[p.vertex[2]]).normalized())) > 0.999;
    }));
}

TEST(Facing, HalfShiftedSheetsFaceVertexToEdge)
{
    Sheets sheets;
    sheets.add(6, 0.01, Vec3(0, 0, 0));
    sheets.add(6, 0.01, Vec3(0.005, 0.002, 0));
    const std::vector<NearPair> pairs = sheets.facing(0.003);
    expect_each_once(pairs);
    std::vector<int> count(72);
    for (const NearPair& pair : pairs)
        if (!pair.is_edge_edge)
            ++count[pair.vertex[0]];
    for (int j = 0; j < 6; ++j)
        for (int i = 1; i < 5; ++i)
            EXPECT_EQ(count[6 * j + i], 1);
}

TEST(Facing, AFlatSheetFacesNothing)
{
    Sheets sheets;
    sheets.add(8, 0.01, Vec3(0, 0, 0));
    std::vector<NearPair> pairs;
    NearPairs(sheets.triangles, sheets.x).find(sheets.x, {}, 0.02, pairs);
    EXPECT_GT(pairs.size(), 1000u);
    EXPECT_TRUE(sheets.facing(0.02).empty());
}

TEST(Facing, CrossedRidgesMeetInOneEdgePair)
{
    // Two roofs, back to back, with perpendicular ridges: along z on top of the lower, along x below the
    // upper.
    Sheets sheets;
    sheets.x = {Vec3(0, 0, -1),   Vec3(0, 0, 1),   Vec3(-1, -1, 0),  Vec3(1, -1, 0),
                Vec3(-1, 0.1, 0), Vec3(1, 0.1, 0), Vec3(0, 1.1, -1), Vec3(0, 1.1, 1)};
    sheets.triangles = {{0, 1, 2}, {1, 0, 3}, {4, 5, 6}, {5, 4, 7}};
    const std::vector<NearPair> pairs = sheets.facing(0.2);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_TRUE(pairs[0].is_edge_edge);
    EXPECT_NEAR(pairs[0].distance, 0.1, 1e-15);
    EXPECT_NEAR(pairs[0].normal.y(), -1.0, 1e-15);
    // Inverted roofs: the ridges are farthest apart and do not face each other.
    for (const int v : {2, 3, 6, 7})
        sheets.x[v].y() *= -0.5;
    for (const NearPair& pair : sheets.facing(0.2))
        EXPECT_NE(features(pair), (std::set<int>{0, 1, 4, 5}));
}

TEST(Facing, AVertexBesideAConvexEdgeFacesTheEdgeOnce)
{
    Sheets sheets;
    sheets.x = {Vec3(0, 0, -1),        Vec3(0, 0, 1),     Vec3(-1, -1, 0),   Vec3(1, -1, 0),
                Vec3(0.001, 0.1, 0.1), Vec3(0.5, 1, 0.3), Vec3(-0.5, 1, 0.2)};
    sheets.triangles = {{0, 1, 2}, {1, 0, 3}, {4, 5, 6}};
    const std::vector<NearPair> pairs = sheets.facing(0.2);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(features(pairs[0]), (std::set<int>{0, 1, 4}));
    EXPECT_EQ(pairs[0].vertex[0], 4);
}

} // namespace
} // namespace toile::test
