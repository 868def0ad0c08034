#include "collision/geometry/distance.h"

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace toile::test {

using namespace collision;

namespace {

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high)
    {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    Vec3 point() { return Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }

private:
    std::mt19937 engine_;
};

/// Min squared distance to an n x n barycentric sampling of the triangle.
double sampled_distance2(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, int n)
{
    double best = std::numeric_limits<double>::max();
    for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
            best = std::min(best, (p - a - double(i) / n * (b - a) - double(j) / n * (c - a)).squaredNorm());
    return best;
}

void expect_consistent(const ClosestOnTriangle& closest, const Vec3& p, const Vec3& a, const Vec3& b,
                       const Vec3& c)
{
    const Vec3& w = closest.barycentric;
    EXPECT_GE(w.minCoeff(), 0.0);
    EXPECT_NEAR(w.sum(), 1.0, 1e-13);
    EXPECT_LT((w[0] * a + w[1] * b + w[2] * c - closest.point).norm(), 1e-12);
    EXPECT_NEAR((p - closest.point).squaredNorm(), closest.distance2, 1e-14);
    if (const int edge = edge_of(closest.feature); edge >= 0) {
        EXPECT_EQ(w[(edge + 2) % 3], 0.0);
    }
    if (const int vertex = vertex_of(closest.feature); vertex >= 0) {
        EXPECT_EQ(w[vertex], 1.0);
    }
}

TEST(ClosestOnTriangle, IsNoFartherThanAnySampledPoint)
{
    Random random(3);
    int seen[7] = {};
    for (int i = 0; i < 400; ++i) {
        const Vec3 a = random.point(), b = random.point(), c = random.point(), p = 1.5 * random.point();
        const ClosestOnTriangle closest = closest_on_triangle(p, a, b, c);
        const double sampled = std::sqrt(sampled_distance2(p, a, b, c, 60));
        EXPECT_LE(std::sqrt(closest.distance2), sampled + 1e-12);
        EXPECT_GE(std::sqrt(closest.distance2), sampled - 0.06);
        expect_consistent(closest, p, a, b, c);
        ++seen[int(closest.feature)];
    }
    for (const int count : seen)
        EXPECT_GT(count, 10);
}

TEST(ClosestOnTriangle, IsAStationaryPointOfTheDistance)
{
    // Moving the closest point towards any corner must not come nearer (the triangle is convex).
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const Vec3 corner[3] = {random.point(), random.point(), random.point()};
        const Vec3 p = 1.5 * random.point();
        const ClosestOnTriangle closest = closest_on_triangle(p, corner[0], corner[1], corner[2]);
        for (const Vec3& towards : corner)
            EXPECT_LE((p - closest.point).dot(towards - closest.point), 1e-12);
    }
}

TEST(ClosestOnTriangle, TreatsACollapsedTriangleAsItsLongestEdge)
{
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = random.point(), b = random.point(), p = random.point();
        const Vec3 c = a + random.uniform(0.0, 1.0) * (b - a);
        const double s = closest_on_segment(p, a, b);
        for (const ClosestOnTriangle& closest :
             {closest_on_triangle(p, a, b, c), closest_on_triangle(p, c, a, b),
              closest_on_triangle(p, b, c, a)})
            EXPECT_NEAR(std::sqrt(closest.distance2), (p - a - s * (b - a)).norm(), 1e-9);
    }
    const Vec3 point = random.point();
    const ClosestOnTriangle closest = closest_on_triangle(Vec3::Zero(), point, point, point);
    EXPECT_EQ(closest.distance2, point.squaredNorm());
    EXPECT_GE(vertex_of(closest.feature), 0);
}

/// Distance of two segments by ternary search over s of the distance from a point of a to segment b (convex
/// in s).
double segment_distance_by_search(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1)
{
    const auto distance = [&](double s) {
        const Vec3 p = a0 + s * (a1 - a0);
        return (p - b0 - closest_on_segment(p, b0, b1) * (b1 - b0)).norm();
    };
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 200; ++i) {
        const double left = low + (high - low) / 3, right = high - (high - low) / 3;
        (distance(left) < distance(right) ? high : low) = distance(left) < distance(right) ? right : left;
    }
    return std::min({distance(0.5 * (low + high)), distance(0.0), distance(1.0)});
}

TEST(ClosestOnSegments, MatchesAConvexSearch)
{
    Random random(6);
    int interior = 0;
    for (int i = 0; i < 500; ++i) {
        const Vec3 a0 = random.point(), a1 = random.point(), b0 = random.point(), b1 = random.point();
        const ClosestOnSegments closest = closest_on_segments(a0, a1, b0, b1);
        EXPECT_NEAR(std::sqrt(closest.distance2), segment_distance_by_search(a0, a1, b0, b1), 1e-8);
        EXPECT_TRUE(closest.s >= 0 && closest.s <= 1 && closest.t >= 0 && closest.t <= 1);
        interior += closest.s > 0 && closest.s < 1 && closest.t > 0 && closest.t < 1;
    }
    EXPECT_GT(interior, 50);
}

TEST(ClosestOnSegments, StaysExactForParallelAndNearlyParallelSegments)
{
    Random random(7);
    for (const double tilt : {0.0, 1e-12, 1e-8, 1e-6, 1e-5, 1e-4})
        for (int i = 0; i < 100; ++i) {
            const Vec3 a0 = random.point(), a1 = random.point();
            const double slide = random.uniform(-1.5, 1.5);
            const Vec3 b0 = a0 + slide * (a1 - a0) + tilt * random.point();
            const Vec3 b1 = b0 + random.uniform(-1.5, 1.5) * (a1 - a0) + tilt * random.point();
            EXPECT_NEAR(std::sqrt(closest_on_segments(a0, a1, b0, b1).distance2),
                        segment_distance_by_search(a0, a1, b0, b1), 3e-8)
                << tilt;
        }
}

TEST(ClosestOnSegments, AcceptsSegmentsOfNoLength)
{
    const Vec3 a(0.1, 0.2, 0.3), b0(1, 0, 0), b1(1, 1, 0);
    EXPECT_NEAR(closest_on_segments(a, a, b0, b1).distance2, (a - Vec3(1, 0.2, 0)).squaredNorm(), 1e-15);
    EXPECT_NEAR(closest_on_segments(b0, b1, a, a).distance2, (a - Vec3(1, 0.2, 0)).squaredNorm(), 1e-15);
    EXPECT_NEAR(closest_on_segments(a, a, b0, b0).distance2, (a - b0).squaredNorm(), 1e-15);
}

} // namespace
} // namespace toile::test
