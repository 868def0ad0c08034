#include "collision/bvh/triangle_tree.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "collision/geometry/distance.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

Vec3 random_vector(std::mt19937& random, double reach)
{
    std::uniform_real_distribution<double> uniform(-reach, reach);
    const double x = uniform(random), y = uniform(random);
    return {x, y, uniform(random)};
}

/// Lumpy ball away from the origin, moved once after the tree was built.
class TriangleTreeTest : public ::testing::Test {
protected:
    TriangleTreeTest()
    {
        tree_.build(mesh_.triangles, mesh_.positions);
        for (Vec3& x : mesh_.positions)
            x = Vec3(0.7 * x.y(), 1.3 * x.x() - 2.0, x.z()) + random_vector(random_, 0.004);
        tree_.refit(mesh_.positions);
    }

    ClosestOnTriangle closest_on(int t, const Vec3& p) const
    {
        const Triangle& v = mesh_.triangles[t];
        return closest_on_triangle(p, mesh_.positions[v[0]], mesh_.positions[v[1]], mesh_.positions[v[2]]);
    }
    Vec3 normal(int t) const
    {
        const Triangle& v = mesh_.triangles[t];
        return (mesh_.positions[v[1]] - mesh_.positions[v[0]])
            .cross(mesh_.positions[v[2]] - mesh_.positions[v[0]])
            .normalized();
    }
    Vec3 somewhere() { return bounds(mesh_.positions).center() + random_vector(random_, 0.5); }

    std::mt19937 random_{3};
    TriangleMesh mesh_ = testing::sphere_mesh(Vec3(0.5, 1.5, -0.7), 0.3, 4);
    TriangleTree tree_;
};

TEST_F(TriangleTreeTest, FindsEveryTriangleWithinARadiusWithAnotherNormal)
{
    size_t named = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = somewhere(), n = random_vector(random_, 1.0).normalized();
        std::vector<int> count(mesh_.triangle_count(), 0);
        tree_.visit_within(p, 0.1, n, 0.5, [&](int t) { ++count[t]; });
        for (int t = 0; t < mesh_.triangle_count(); ++t) {
            ASSERT_LE(count[t], 1);
            named += count[t];
            const bool is_near = closest_on(t, p).distance2 <= 0.01;
            ASSERT_GE(count[t], int(is_near && normal(t).dot(n) <= 0.5)) << t;
            ASSERT_LE(count[t], int(normal(t).dot(n) < 0.501)) << t;
        }
    }
    EXPECT_GT(named, 0);
    EXPECT_LT(named, 200 * size_t(mesh_.triangle_count()) / 5); // few visits in vain
}

TEST_F(TriangleTreeTest, FindsEveryTriangleAroundASegment)
{
    size_t named = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = somewhere(), b = a + random_vector(random_, 0.1);
        std::vector<int> count(mesh_.triangle_count(), 0);
        tree_.visit_near(a, b, 0.02, [&](int t) { ++count[t]; });
        for (int t = 0; t < mesh_.triangle_count(); ++t) {
            named += count[t];
            for (const double along : {0.0, 0.3, 0.8, 1.0})
                ASSERT_GE(count[t], int(closest_on(t, (1.0 - along) * a + along * b).distance2 <= 0.0004))
                    << t;
        }
    }
    EXPECT_GT(named, 0);
    EXPECT_LT(named, 200 * size_t(mesh_.triangle_count()) / 20);
}

TEST_F(TriangleTreeTest, FindsTheNearestTriangleAfterFewVisits)
{
    size_t named = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = somewhere();
        double nearest = std::numeric_limits<double>::infinity(), expected = nearest;
        for (int t = 0; t < mesh_.triangle_count(); ++t)
            expected = std::min(expected, std::sqrt(closest_on(t, p).distance2));
        tree_.visit_nearest(p, nearest, [&](int t) {
            ++named;
            nearest = std::min(nearest, std::sqrt(closest_on(t, p).distance2));
            return nearest;
        });
        EXPECT_EQ(nearest, expected);
    }
    EXPECT_LT(named, 200 * size_t(mesh_.triangle_count()) / 10);
}

TEST_F(TriangleTreeTest, NeverFindsNonFiniteTriangles)
{
    const int lost = 17;
    mesh_.positions[mesh_.triangles[lost][1]].y() = std::numeric_limits<double>::quiet_NaN();
    tree_.refit(mesh_.positions);
    int named = 0;
    const auto count = [&](int t) {
        EXPECT_GE(t, 0);
        EXPECT_LT(t, mesh_.triangle_count());
        EXPECT_NE(t, lost);
        ++named;
        return -1.0;
    };
    tree_.visit_nearest(Vec3::Zero(), std::numeric_limits<double>::infinity(), count);
    EXPECT_GT(named, mesh_.triangle_count() - 10);
    EXPECT_LT(named, mesh_.triangle_count());
}

TEST(TriangleTree, AcceptsOneTriangleOrNone)
{
    const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<Triangle> one{{0, 1, 2}}, none;
    std::vector<int> named;
    TriangleTree tree;
    tree.build(one, x);
    tree.visit_near(Vec3(0.2, 0.2, 0.05), Vec3(0.2, 0.2, 0.5), 0.1, [&](int t) { named.push_back(t); });
    EXPECT_EQ(named, std::vector<int>{0});
    tree.build(none, x);
    tree.visit_near(Vec3::Zero(), Vec3::Ones(), 1.0, [&](int) { ADD_FAILURE(); });
}

} // namespace
} // namespace toile::test
