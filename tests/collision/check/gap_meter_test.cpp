#include "collision/check/gap_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/compute/parallel.h"

namespace toile::test {

using namespace collision;

namespace {

/// Strip of `length` cells of 1 cm by 3 along x, `rows` of them in depth, in the plane y = 0.
struct Strip {
    std::vector<Triangle> triangles;
    std::vector<Vec3> rest;
};
Strip strip(int length)
{
    constexpr int kRows = 3;
    constexpr double kCell = 0.01;
    Strip result;
    for (int i = 0; i <= length; ++i)
        for (int j = 0; j <= kRows; ++j)
            result.rest.push_back(kCell * Vec3(i, 0, j));
    for (int i = 0; i < length; ++i)
        for (int j = 0; j < kRows; ++j) {
            const int v = i * (kRows + 1) + j;
            result.triangles.push_back(Triangle(v, v + 1, v + kRows + 1));
            result.triangles.push_back(Triangle(v + 1, v + kRows + 2, v + kRows + 1));
        }
    return result;
}

TEST(GapMeter, FindsNothingInAFlatOrGentlyBentSheet)
{
    const Strip cloth = strip(30);
    const GapMeter meter(cloth.triangles, cloth.rest);
    EXPECT_FALSE(meter.measure(cloth.rest, 0.05));
    std::vector<Vec3> x = cloth.rest;
    for (Vec3& p : x)
        p = Vec3(0.1 * std::sin(p.x() / 0.1), 0.1 * std::cos(p.x() / 0.1), p.z());
    EXPECT_FALSE(meter.measure(x, 0.05));
}

TEST(GapMeter, MeasuresAFold)
{
    // A hairpin: two flat legs 4 mm apart around a half circle.
    const double radius = 0.002;
    const Strip cloth = strip(40);
    std::vector<Vec3> x = cloth.rest;
    for (Vec3& p : x) {
        const double s = p.x() - 0.2, bend = std::numbers::pi * radius / 2;
        if (s < -bend)
            p = Vec3(s + bend, radius, p.z());
        else if (s > bend)
            p = Vec3(bend - s, -radius, p.z());
        else
            p = Vec3(radius * std::cos(s / radius), -radius * std::sin(s / radius), p.z());
    }
    const GapMeter meter(cloth.triangles, cloth.rest);
    const auto gap = meter.measure(x, 0.005);
    ASSERT_TRUE(gap);
    EXPECT_GT(gap->distance, 0.0015); // across the crease the 1 cm cells cut the corner
    EXPECT_LT(gap->distance, 0.0040001);
    EXPECT_FALSE(meter.measure(x, 0.0015));
}

TEST(GapMeter, MeasuresACornerOverATriangleAndAnEdgeOverAnEdge)
{
    const std::vector<Triangle> two{Triangle(0, 1, 2), Triangle(3, 4, 5)};
    const auto gap_of = [&](const std::vector<Vec3>& x) {
        return GapMeter(two, x).measure(x, 0.05).value_or(GapMeter::Gap{-1.0}).distance;
    };
    EXPECT_NEAR(gap_of({Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, 0, 1), Vec3(0, 0.001, -0.2),
                        Vec3(0.1, 1, -0.2), Vec3(-0.1, 1, -0.2)}),
                0.001, 1e-15);
    EXPECT_NEAR(gap_of({Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0.002, -1), Vec3(0, 0.002, 1),
                        Vec3(0, 1, 0)}),
                0.002, 1e-15);
}

TEST(GapMeter, MeasuresBetweenPieces)
{
    // Two strips above each other, shifted so that vertices face triangles, then crossed so that edges meet.
    const Strip one = strip(10);
    std::vector<Triangle> triangles = one.triangles;
    std::vector<Vec3> rest = one.rest;
    const int count = int(one.rest.size());
    for (const Triangle& t : one.triangles)
        triangles.push_back(t + Triangle::Constant(count));
    for (const Vec3& p : one.rest)
        rest.push_back(p + Vec3(0.003, 0.0012, 0.002));
    const GapMeter meter(triangles, rest);
    ASSERT_TRUE(meter.measure(rest, 0.005));
    EXPECT_NEAR(meter.measure(rest, 0.005)->distance, 0.0012, 1e-15);
    EXPECT_FALSE(meter.measure(rest, 0.0012));

    // Tilted about its long side, its border edge is nearest: below it edges run across.
    std::vector<Vec3> x = rest;
    for (int v = count; v < 2 * count; ++v) {
        const Vec3& p = one.rest[v - count];
        x[v] = Vec3(p.x() + 0.005, 0.0007 + p.z(), 0.0152 + 0.3 * p.z());
    }
    EXPECT_NEAR(meter.measure(x, 0.005)->distance, 0.0007, 1e-15);
}

TEST(GapMeter, IsThreadIndependentAndSkipsNonFiniteVertices)
{
    const Strip cloth = strip(200);
    std::vector<Vec3> x = cloth.rest;
    for (Vec3& p : x)
        p = Vec3(0.03 * std::sin(40.0 * p.x()), 0.001 * p.x() + 0.02 * std::cos(37.0 * p.x()), p.z());
    x[17].y() = std::nan("");
    const GapMeter meter(cloth.triangles, cloth.rest);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return meter.measure(x, 0.01);
    };
    ASSERT_TRUE(with(1));
    EXPECT_EQ(with(1)->distance, with(4)->distance);
    EXPECT_EQ(with(1)->point, with(4)->point);
}

} // namespace
} // namespace toile::test
