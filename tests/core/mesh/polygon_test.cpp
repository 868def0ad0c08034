#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "core/mesh/polygon.h"

namespace toile::test {

namespace {

/// Signed areas along `normal` of the triangles [m^2], smallest first, and their sum.
struct Areas {
    double smallest = 1e300, sum = 0.0;
};

Areas areas_of(const std::vector<Vec3>& corners, const Vec3& normal)
{
    Areas areas;
    for (const Triangle& t : triangulate_polygon(corners)) {
        const double area =
            0.5 * (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]).dot(normal);
        areas.smallest = std::min(areas.smallest, area);
        areas.sum += area;
    }
    return areas;
}

/// Smallest angle of the triangles [degrees].
double smallest_angle(const std::vector<Vec3>& corners)
{
    double smallest = 180.0;
    for (const Triangle& t : triangulate_polygon(corners))
        for (int k = 0; k < 3; ++k) {
            const Vec3 a = corners[t[(k + 1) % 3]] - corners[t[k]],
                       b = corners[t[(k + 2) % 3]] - corners[t[k]];
            smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / std::numbers::pi);
        }
    return smallest;
}

TEST(TriangulatePolygon, KeepsConvexQuadsAsFans)
{
    const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    EXPECT_EQ(triangulate_polygon(square), (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(TriangulatePolygon, SplitsConcaveQuadsInside)
{
    for (int first = 0; first < 4; ++first) {
        const std::vector<Vec3> dart{{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
        std::vector<Vec3> corners = dart;
        std::rotate(corners.begin(), corners.begin() + first, corners.end());
        const Areas areas = areas_of(corners, Vec3::UnitZ());
        EXPECT_GT(areas.smallest, 0.0);
        EXPECT_NEAR(areas.sum, 1.0, 1e-12);
    }
}

/// Corners on straight sides, as where a finer part of a mesh begins.
TEST(TriangulatePolygon, LeavesNoFlatTriangleAtCornersOnSides)
{
    std::vector<Vec3> corners{{0, 0, 0}};
    for (int k = 1; k <= 8; ++k)
        corners.push_back(Vec3(0.125 * k, 0, 0));
    corners.push_back({1, 1, 0});
    corners.push_back({0.5, 1, 0});
    corners.push_back({0, 1, 0});
    corners.push_back({0, 0.5, 0});
    const Areas areas = areas_of(corners, Vec3::UnitZ());
    EXPECT_GT(areas.smallest, 1e-3);
    EXPECT_NEAR(areas.sum, 1.0, 1e-12);
    const std::vector<Vec3> on_first_side{{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_GT(areas_of(on_first_side, Vec3::UnitZ()).smallest, 0.1);
}

/// The corners of a regular polygon lie on a circle: no triangulation has an angle above pi / n in all of
/// them.
TEST(TriangulatePolygon, HasTheAnglesThatARegularPolygonAllows)
{
    for (const int n : {5, 12, 64, 200}) {
        std::vector<Vec3> corners;
        for (int k = 0; k < n; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / n;
            corners.push_back(Vec3(std::cos(angle), 0.0, -std::sin(angle)));
        }
        EXPECT_EQ(int(triangulate_polygon(corners).size()), n - 2);
        EXPECT_NEAR(smallest_angle(corners), 180.0 / n, 1e-9);
    }
}

/// Stars of random radii, in random planes and a little out of them.
TEST(TriangulatePolygon, CoversRandomConcavePolygonsOnce)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int trial = 0; trial < 300; ++trial) {
        const int n = 4 + trial % 40;
        const Eigen::Quaterniond Q =
            Eigen::Quaterniond(number(random), number(random), number(random), 1.5).normalized();
        std::vector<Vec3> corners, flat;
        double area = 0.0;
        for (int k = 0; k < n; ++k) {
            const double angle = 2.0 * std::numbers::pi * k / n, radius = 1.2 + number(random);
            flat.push_back(Q * Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0));
            corners.push_back(flat.back() + 1e-3 * number(random) * (Q * Vec3::UnitZ()));
        }
        for (int k = 0; k < n; ++k)
            area += 0.5 * flat[k].cross(flat[(k + 1) % n]).dot(Q * Vec3::UnitZ());
        const std::vector<Triangle> triangles = triangulate_polygon(corners);
        ASSERT_EQ(int(triangles.size()), n - 2);
        double sum = 0.0;
        for (const Triangle& t : triangles) {
            const double signed_area =
                0.5 * (flat[t[1]] - flat[t[0]]).cross(flat[t[2]] - flat[t[0]]).dot(Q * Vec3::UnitZ());
            EXPECT_GT(signed_area, -1e-3) << "trial " << trial;
            sum += signed_area;
        }
        EXPECT_NEAR(sum, area, 1e-9) << "trial " << trial;
    }
}

/// What no file should have must not fail here; the checks of meshes name it.
TEST(TriangulatePolygon, EndsForDegeneratePolygons)
{
    const std::vector<Vec3> point(6, Vec3::Zero());
    const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5, 0, 0}};
    const std::vector<Vec3> crossing{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}};
    for (const std::vector<Vec3>& corners : {point, line, crossing})
        EXPECT_EQ(triangulate_polygon(corners).size(), corners.size() - 2);
}

TEST(ConvexHull, LeavesOutPointsOnItsSides)
{
    const std::vector<Vec2> hull = convex_hull({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 0.5}, {0, 0}, {0, 1}});
    ASSERT_EQ(hull.size(), 4u);
    double doubled = 0.0;
    for (size_t i = 0; i < hull.size(); ++i)
        doubled += hull[i].x() * hull[(i + 1) % 4].y() - hull[i].y() * hull[(i + 1) % 4].x();
    EXPECT_DOUBLE_EQ(doubled, 4.0) << "counter-clockwise";
}

} // namespace
} // namespace toile::test
