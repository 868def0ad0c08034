#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "avatars/landmarks/cross_section.h"

namespace toile::test {

using namespace avatars;

namespace {

constexpr int kSides = 256, kRings = 96;

/// Torus about Y: a ring of radius 1 m of a tube of radius 0.25 m.
TriangleMesh torus()
{
    TriangleMesh mesh;
    for (int i = 0; i < kSides; ++i)
        for (int j = 0; j < kRings; ++j) {
            const double a = 2.0 * std::numbers::pi * i / kSides, b = 2.0 * std::numbers::pi * j / kRings;
            const double r = 1.0 + 0.25 * std::cos(b);
            mesh.positions.emplace_back(r * std::cos(a), 0.25 * std::sin(b), r * std::sin(a));
        }
    const auto at = [](int i, int j) { return (i % kSides) * kRings + j % kRings; };
    for (int i = 0; i < kSides; ++i)
        for (int j = 0; j < kRings; ++j) {
            mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j));
            mesh.triangles.emplace_back(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        }
    return mesh;
}

} // namespace

TEST(CrossSection, UprightPlaneCutsATorusInTwoCircles)
{
    const SectionPlane plane = SectionPlane::through(Vec3(0.0, 0.0, 1e-3), Vec3::UnitZ());
    const std::vector<SectionLoop> loops = cut(torus(), plane);
    ASSERT_EQ(loops.size(), 2u);
    for (const SectionLoop& loop : loops) {
        EXPECT_NEAR(loop.area, std::numbers::pi * 0.25 * 0.25, 1e-3);
        EXPECT_NEAR(std::abs(loop.center.x()), 1.0, 1e-3);
        EXPECT_NEAR(closed_length(loop.points), std::numbers::pi * 0.5, 1e-3);
        EXPECT_NEAR(loop.width(1), 0.5, 1e-3);
    }
    EXPECT_NEAR(loops[0].center.x() + loops[1].center.x(), 0.0, 1e-6);
}

TEST(CrossSection, LevelPlaneCutsItInRingsAndTheLargestComesFirst)
{
    const std::vector<SectionLoop> loops =
        cut(torus(), SectionPlane::through(Vec3(0.0, 1e-4, 0.0), Vec3::UnitY()));
    ASSERT_EQ(loops.size(), 2u);
    EXPECT_NEAR(loops[0].area, std::numbers::pi * 1.25 * 1.25, 0.01);
    EXPECT_NEAR(loops[1].area, std::numbers::pi * 0.75 * 0.75, 0.01);
    EXPECT_TRUE(cut(torus(), SectionPlane::through(Vec3(0.0, 0.3, 0.0), Vec3::UnitY())).empty());
}

TEST(CrossSection, TapeSpansHollows)
{
    // A square of 1 m with a notch to its middle: 4 m of tape, more along the curve.
    const std::vector<Vec3> notched{{0, 0, 0}, {0, 0, 1}, {0.5, 0, 0.5}, {1, 0, 1}, {1, 0, 0}};
    EXPECT_NEAR(closed_length(convex_hull(notched, SectionPlane::through(Vec3::Zero(), Vec3::UnitY()))), 4.0,
                1e-12);
    EXPECT_GT(closed_length(notched), 4.4);
}

TEST(CrossSection, CurveThatEndsAtABorderIsWhole)
{
    // A strip along x, open at both ends and sides.
    TriangleMesh strip;
    for (int i = 0; i <= 10; ++i)
        for (const double y : {-1.0, 1.0})
            strip.positions.emplace_back(i, y, 0.1 * i * i);
    for (int i = 0; i < 10; ++i) {
        strip.triangles.emplace_back(2 * i, 2 * i + 2, 2 * i + 1);
        strip.triangles.emplace_back(2 * i + 2, 2 * i + 3, 2 * i + 1);
    }
    const std::vector<SectionLoop> loops =
        cut(strip, SectionPlane::through(Vec3(0.0, 0.25, 0.0), Vec3::UnitY()));
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_NEAR(loops[0].width(0), 10.0, 1e-12);
    EXPECT_EQ(loops[0].points.size(), 21u);
    EXPECT_FALSE(loops[0].is_closed());
    EXPECT_EQ(loops[0].triangles.size(), 21u);
    EXPECT_EQ(std::count(loops[0].triangles.begin(), loops[0].triangles.end(), -1), 1) << "the chord";
}

TEST(CrossSection, NamesTheTriangleBetweenTwoPoints)
{
    const TriangleMesh mesh = torus();
    for (const SectionLoop& loop : cut(mesh, SectionPlane::through(Vec3(0.0, 1e-4, 0.0), Vec3::UnitY()))) {
        EXPECT_TRUE(loop.is_closed());
        ASSERT_EQ(loop.triangles.size(), loop.points.size());
        for (size_t i = 0; i < loop.points.size(); ++i) {
            const Triangle& t = mesh.triangles[size_t(loop.triangles[i])];
            const Vec3 middle = 0.5 * (loop.points[i] + loop.points[(i + 1) % loop.points.size()]);
            const Vec3 &a = mesh.positions[size_t(t[0])], &b = mesh.positions[size_t(t[1])],
                       &c = mesh.positions[size_t(t[2])];
            const double parts = (b - middle).cross(c - middle).norm() +
                                 (c - middle).cross(a - middle).norm() +
                                 (a - middle).cross(b - middle).norm();
            EXPECT_NEAR(parts, (b - a).cross(c - a).norm(), 1e-12) << "inside of it";
        }
    }
}

} // namespace toile::test
