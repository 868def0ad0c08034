#include "collision/body/clearance.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

Vec3 random_vector(std::mt19937& random, double length)
{
    std::uniform_real_distribution<double> along(-length, length);
    return {along(random), along(random), along(random)};
}

/// A ball with independently moving vertices, cloth vertices around it, and the results of an exact search.
class ClearanceTest : public ::testing::Test {
protected:
    static constexpr int kCount = 200;

    void SetUp() override
    {
        for (int v = 0; v < kCount; ++v)
            x_.push_back(random_vector(random_, 0.3));
    }

    double distance_of(int v) const { return collider_.surface().closest(x_[v])->signed_distance; }

    void search()
    {
        for (int v = 0; v < kCount; ++v)
            clearance_.record(v, std::max(distance_of(v), 0.0), -1);
    }

    void move_mesh(const Vec3& common, double scatter)
    {
        mesh_.x_t0 = mesh_.x_t1;
        for (Vec3& x : mesh_.x_t1)
            x += common + random_vector(random_, scatter);
        collider_.move(mesh_);
    }

    std::mt19937 random_{5};
    TriangleMesh ball_ = testing::sphere_mesh(Vec3::Zero(), 0.12, 3);
    MovingMesh mesh_{ball_.triangles, ball_.positions, ball_.positions};
    MeshCollider collider_{mesh_};
    std::vector<Vec3> x_;
    Clearance clearance_{kCount};
};

TEST_F(ClearanceTest, IsALowerBoundOfTheDistance)
{
    clearance_.follow(x_, collider_);
    search();
    int known = 0, clear_edges = 0;
    for (int step = 0; step < 20; ++step) {
        move_mesh(random_vector(random_, 0.006), step % 2 == 0 ? 0.002 : 0.0);
        for (Vec3& x : x_)
            x += random_vector(random_, 0.004);
        clearance_.follow(x_, collider_);
        for (int v = 0; v < kCount; ++v) {
            ASSERT_LE(clearance_.of(v), std::max(distance_of(v), 0.0)) << step << ", vertex " << v;
            known += clearance_.of(v) > 0.0;
            const int w = (v + 1) % kCount;
            const double along = 0.37;
            const Vec3 between = (1.0 - along) * x_[v] + along * x_[w];
            const double distance = collider_.surface().closest(between)->distance();
            ASSERT_FALSE(clearance_.is_edge_clear(v, w, distance));
            clear_edges += clearance_.is_edge_clear(v, w, 0.001);
        }
        if (step % 5 == 4)
            search();
    }
    EXPECT_GT(known, 20 * kCount / 10); // the bounds are not trivially zero
    EXPECT_GT(clear_edges, 0);
}

TEST_F(ClearanceTest, IsKeptWhenClothMovesWithTheMesh)
{
    clearance_.follow(x_, collider_);
    search();
    std::vector<double> before(kCount);
    for (int v = 0; v < kCount; ++v)
        before[v] = clearance_.of(v);
    const Vec3 along(0.05, 0.02, -0.03);
    move_mesh(along, 0.0);
    for (Vec3& x : x_)
        x += along;
    clearance_.follow(x_, collider_);
    for (int v = 0; v < kCount; ++v)
        EXPECT_GE(clearance_.of(v), before[v] - 1e-8);
}

TEST_F(ClearanceTest, IsZeroAtFirstAndAfterMissedSteps)
{
    clearance_.follow(x_, collider_);
    for (int v = 0; v < kCount; ++v)
        EXPECT_EQ(clearance_.of(v), 0.0);
    search();
    move_mesh(Vec3(0.0, 0.01, 0.0), 0.0);
    move_mesh(Vec3(0.0, 0.01, 0.0), 0.0);
    clearance_.follow(x_, collider_);
    for (int v = 0; v < kCount; ++v)
        EXPECT_EQ(clearance_.of(v), 0.0);
}

} // namespace
} // namespace toile::test
