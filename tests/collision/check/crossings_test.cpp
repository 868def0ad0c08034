#include "collision/check/find_crossings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "collision/bvh/ray_scene.h"
#include "collision/check/crosses.h"
#include "collision/geometry/distance.h"
#include "core/compute/parallel.h"
#include "tests/collision/check/exact_overlap.h"

namespace toile::test {

using namespace collision;

namespace {

/// Pairs of triangles of a soup that share more than their common corners, by the oracle.
std::set<std::pair<int, int>> pairs_by_oracle(const std::vector<Triangle>& triangles,
                                              const std::vector<Vec3>& x)
{
    std::set<std::pair<int, int>> pairs;
    for (int a = 0; a < int(triangles.size()); ++a)
        for (int b = a + 1; b < int(triangles.size()); ++b) {
            const std::set<int> in_a(triangles[a].begin(), triangles[a].end());
            const std::set<int> in_b(triangles[b].begin(), triangles[b].end());
            std::vector<Vec3> of_a, of_b, shared;
            for (const int v : in_a) {
                of_a.push_back(x[v]);
                if (in_b.count(v) > 0)
                    shared.push_back(x[v]);
            }
            for (const int v : in_b)
                of_b.push_back(x[v]);
            if (shared.size() < 3 && overlap_beyond(of_a, of_b, shared))
                pairs.insert({a, b});
        }
    return pairs;
}

std::set<std::pair<int, int>> pairs_of(const std::vector<Crossing>& crossings)
{
    std::set<std::pair<int, int>> pairs;
    for (const Crossing& crossing : crossings)
        pairs.insert({crossing.a, crossing.b});
    EXPECT_EQ(pairs.size(), crossings.size());
    return pairs;
}

/// All points of {0, 1, 2}^3.
std::vector<Vec3> grid()
{
    std::vector<Vec3> points;
    points.reserve(27);
    for (int z = 0; z < 3; ++z)
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x)
                points.push_back(Vec3(x, y, z));
    return points;
}

TEST(Crosses, AgreesWithRationalArithmeticOnAGrid)
{
    // A proper triangle, one in a coordinate plane, a segment, and a point against all multisets of 3 points.
    const std::vector<Vec3> p = grid();
    const std::vector<std::array<Vec3, 3>> first = {
        {p[0], p[14], p[19]}, {p[9], p[15], p[11]}, {p[0], p[13], p[26]}, {p[13], p[13], p[13]}};
    int crossing_count = 0;
    for (const std::array<Vec3, 3>& a : first)
        for (int i = 0; i < 27; ++i)
            for (int j = i; j < 27; ++j)
                for (int k = j; k < 27; ++k) {
                    const std::array<Vec3, 3> b{p[i], p[j], p[k]};
                    const bool is_flat = has_no_area(a[0], a[1], a[2]) || has_no_area(b[0], b[1], b[2]);
                    const bool expected = overlap_beyond({a.begin(), a.end()}, {b.begin(), b.end()}, {});
                    ASSERT_EQ(crosses({a, b, 0, is_flat}), expected) << i << " " << j << " " << k;
                    crossing_count += expected ? 1 : 0;
                }
    EXPECT_GT(crossing_count, 1000);
}

TEST(FindCrossings, AgreesWithRationalArithmeticOnSoupsThatShareCorners)
{
    // Few points and fewer vertices: many coplanar pairs, folds, repeated corners and equal positions.
    std::mt19937 random(5);
    const std::vector<Vec3> points = grid();
    for (int pass = 0; pass < 6; ++pass) {
        std::vector<Vec3> x(12);
        for (Vec3& p : x)
            p = points[random() % points.size()];
        std::vector<Triangle> triangles(60);
        for (Triangle& t : triangles)
            t = Triangle(random() % 12, random() % 12, random() % 12);
        const auto expected = pairs_by_oracle(triangles, x);
        EXPECT_EQ(pairs_of(find_crossings(triangles, x)), expected);
        EXPECT_GT(expected.size(), 100u);
        EXPECT_LT(expected.size(), 1700u);
    }
}

/// Triangles of about 0.4 m at random points in a cube of 1 m, three vertices each.
std::pair<std::vector<Triangle>, std::vector<Vec3>> random_soup(int count, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(0.0, 1.0);
    const auto vector = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
    std::vector<Triangle> triangles;
    std::vector<Vec3> x;
    for (int t = 0; t < count; ++t) {
        const Vec3 center = vector();
        triangles.push_back(Triangle(3 * t, 3 * t + 1, 3 * t + 2));
        for (int k = 0; k < 3; ++k)
            x.push_back(center + 0.4 * (vector() - Vec3::Constant(0.5)));
    }
    return {triangles, x};
}

TEST(FindCrossings, MatchesAllPairs)
{
    const auto [triangles, x] = random_soup(80, 1);
    const auto crossings = find_crossings(triangles, x);
    EXPECT_EQ(pairs_of(crossings), pairs_by_oracle(triangles, x));
    EXPECT_GT(crossings.size(), 10u);
}

TEST(FindCrossings, ReturnsAPointOfBothTriangles)
{
    const auto [triangles, x] = random_soup(300, 2);
    for (const Crossing& crossing : find_crossings(triangles, x))
        for (const int t : {crossing.a, crossing.b}) {
            const Triangle& c = triangles[t];
            const auto closest = closest_on_triangle(crossing.point, x[c[0]], x[c[1]], x[c[2]]);
            EXPECT_LT(std::sqrt(closest.distance2), 1e-12);
        }
}

TEST(FindCrossings, MatchesAllPairsBetweenTwoSoups)
{
    const auto [triangles_a, x_a] = random_soup(150, 3);
    const auto [triangles_b, x_b] = random_soup(100, 4);
    std::vector<Triangle> both = triangles_a;
    std::vector<Vec3> x = x_a;
    for (const Triangle& t : triangles_b)
        both.push_back(t + Triangle::Constant(int(x_a.size())));
    x.insert(x.end(), x_b.begin(), x_b.end());
    std::set<std::pair<int, int>> expected;
    for (const auto& [a, b] : pairs_of(find_crossings(both, x)))
        if (a < 150 && b >= 150)
            expected.insert({a, b - 150});
    EXPECT_EQ(pairs_of(find_crossings(triangles_a, x_a, triangles_b, x_b)), expected);
    EXPECT_GT(expected.size(), 50u);
}

TEST(FindCrossings, GivesTheSameResultForEveryThreadCount)
{
    const auto soup = random_soup(1500, 6);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return find_crossings(soup.first, soup.second);
    };
    const auto one = with(1), four = with(4);
    ASSERT_EQ(one.size(), four.size());
    for (size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].a, four[i].a);
        EXPECT_EQ(one[i].b, four[i].b);
        EXPECT_EQ(one[i].point, four[i].point);
    }
}

/// A square sheet of n x n cells of 1 m in the plane y = 0.
std::pair<std::vector<Triangle>, std::vector<Vec3>> sheet(int n)
{
    std::vector<Vec3> x;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            x.push_back(Vec3(i, 0.0, j));
    std::vector<Triangle> triangles;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const int v = i * (n + 1) + j;
            triangles.push_back(Triangle(v, v + 1, v + n + 1));
            triangles.push_back(Triangle(v + 1, v + n + 2, v + n + 1));
        }
    return {triangles, x};
}

TEST(FindCrossings, FlatAndBentSheetsHaveNone)
{
    auto [triangles, x] = sheet(20);
    EXPECT_TRUE(find_crossings(triangles, x).empty());
    for (Vec3& p : x)
        p.y() = std::sin(p.x()) * std::cos(0.7 * p.z());
    EXPECT_TRUE(find_crossings(triangles, x).empty());
}

TEST(FindCrossings, OneCornerThroughASheetIsFound)
{
    // A needle-thin triangle whose tip passes the sheet by the smallest denormal number, then only touches
    // it, then stays above it by as little. Embree leaves this thread in a mode that flushes denormals.
    RayScene rays;
    rays.add(std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
             std::vector<Triangle>{Triangle(0, 1, 2)});
    rays.commit();
    auto [triangles, x] = sheet(4);
    const int tip = int(x.size());
    const double smallest = std::numeric_limits<double>::denorm_min();
    x.insert(x.end(), {Vec3(1.3, 0.0, 1.2), Vec3(1.3, 1.0, 1.2), Vec3(1.31, 1.0, 1.2)});
    triangles.push_back(Triangle(tip, tip + 1, tip + 2));
    for (const double height : {-smallest, 0.0, smallest}) {
        x[tip].y() = height;
        EXPECT_EQ(find_crossings(triangles, x).size(), height > 0.0 ? 0u : 1u) << height;
    }
}

TEST(FindCrossings, FoldsCountOnlyWhenExactlyFlat)
{
    const std::vector<Triangle> hinge{Triangle(0, 1, 2), Triangle(1, 0, 3)};
    std::vector<Vec3> x{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.4, 1, 0), Vec3(0.6, -1, 0)};
    EXPECT_TRUE(find_crossings(hinge, x).empty());
    x[3] = Vec3(0.6, 1, 1e-300);
    EXPECT_TRUE(find_crossings(hinge, x).empty());
    x[3] = Vec3(0.6, 1, 0);
    EXPECT_EQ(find_crossings(hinge, x).size(), 1u);

    // Around one corner: the second triangle is perpendicular to the first, crosses it obliquely, lies in it.
    const std::vector<Triangle> fan{Triangle(0, 1, 2), Triangle(0, 3, 4)};
    x = {Vec3(0, 0, 0), Vec3(2, -1, 0), Vec3(2, 1, 0), Vec3(1, 0, 1), Vec3(1, 0, 2)};
    EXPECT_TRUE(find_crossings(fan, x).empty());
    x[3].z() = -1.0;
    EXPECT_EQ(find_crossings(fan, x).size(), 1u);
    x[3] = Vec3(1, 0.1, 0);
    x[4] = Vec3(1, -0.1, 0);
    EXPECT_EQ(find_crossings(fan, x).size(), 1u);
}

TEST(FindCrossings, SkipsNonFiniteVertices)
{
    auto [triangles, x] = random_soup(300, 7);
    const size_t all = find_crossings(triangles, x).size();
    for (int v = 0; v < 150; ++v)
        x[3 * v + v % 3].z() = v % 2 == 0 ? std::nan("") : std::numeric_limits<double>::infinity();
    const auto left = find_crossings(triangles, x);
    EXPECT_LT(left.size(), all);
    EXPECT_GT(left.size(), 0u);
    for (const Crossing& crossing : left)
        EXPECT_GE(crossing.a, 150);
    EXPECT_TRUE(find_crossings({}, {}).empty());
}

} // namespace
} // namespace toile::test
