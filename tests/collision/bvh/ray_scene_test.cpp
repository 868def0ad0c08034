#include "collision/bvh/ray_scene.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::box_mesh;
using testing::merged;
using testing::sphere_mesh;

RayScene scene_of(const TriangleMesh& mesh)
{
    RayScene scene;
    scene.add(mesh.positions, mesh.triangles);
    scene.commit();
    return scene;
}

/// First hit by Moeller and Trumbore in double precision over all triangles.
std::optional<RayHit> hit_by_brute_force(const TriangleMesh& mesh, const Vec3& origin, const Vec3& direction)
{
    std::optional<RayHit> best;
    for (int i = 0; i < mesh.triangle_count(); ++i) {
        const Triangle& corner = mesh.triangles[i];
        Mat3 system;
        system << mesh.positions[corner[1]] - mesh.positions[corner[0]],
            mesh.positions[corner[2]] - mesh.positions[corner[0]], -direction;
        const Vec3 uvt = system.inverse() * (origin - mesh.positions[corner[0]]);
        if (uvt.x() >= 0 && uvt.y() >= 0 && uvt.x() + uvt.y() <= 1 && uvt.z() > 0 &&
            (!best || uvt.z() < best->t))
            best = RayHit{0, i, uvt.x(), uvt.y(), uvt.z()};
    }
    return best;
}

TEST(RayScene, FindsTheSameFirstHitAsBruteForce)
{
    const TriangleMesh mesh = sphere_mesh(Vec3(0.3, 1.2, -0.4), 0.5, 3);
    const RayScene scene = scene_of(mesh);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 origin(uniform(random), 1.0 + uniform(random), uniform(random));
        const Vec3 direction(uniform(random), uniform(random), uniform(random));
        const std::optional<RayHit> expected = hit_by_brute_force(mesh, origin, direction);
        const std::optional<RayHit> found = scene.closest_hit(origin, direction, 1e9);
        ASSERT_EQ(found.has_value(), expected.has_value());
        EXPECT_EQ(scene.occluded(origin, direction, 1e9), expected.has_value());
        if (!found)
            continue;
        ++hits;
        EXPECT_NEAR(found->t, expected->t, 1e-5 * (1.0 + expected->t));
        const Triangle& corner = mesh.triangles[found->triangle];
        const Vec3 point = (1.0 - found->u - found->v) * mesh.positions[corner[0]] +
                           found->u * mesh.positions[corner[1]] + found->v * mesh.positions[corner[2]];
        EXPECT_LT((point - origin - found->t * direction).norm(), 1e-5);
    }
    EXPECT_GT(hits, 30);
}

TEST(RayScene, StopsAtTheEndOfTheRay)
{
    const RayScene scene = scene_of(box_mesh(Vec3::Zero(), Vec3::Ones()));
    const Vec3 origin(0.4, 3.0, 0.3);
    EXPECT_FALSE(scene.closest_hit(origin, -Vec3::UnitY(), 1.9));
    EXPECT_FALSE(scene.occluded(origin, -Vec3::UnitY(), 1.9));
    EXPECT_TRUE(scene.occluded(origin, -Vec3::UnitY(), 2.1));
    EXPECT_NEAR(scene.closest_hit(origin, -Vec3::UnitY(), 2.1)->t, 2.0, 1e-6);
}

TEST(RayScene, CountsHitsHoweverNearEachOther)
{
    const RayScene scene = scene_of(box_mesh(Vec3(0, 0, 1), Vec3(1, 1, 1.000002)));
    EXPECT_EQ(scene.hit_count(Vec3(0.4, 0.3, 0.0), Vec3::UnitZ()), 2);
    EXPECT_EQ(scene.hit_count(Vec3(0.4, 0.3, 0.0), -Vec3::UnitZ()), 0);
}

TEST(RayScene, NamesTheMeshThatWasHitAndFollowsItWhenItMoves)
{
    RayScene scene;
    TriangleMesh near = box_mesh(Vec3(0, 0, 1), Vec3(1, 1, 2));
    const TriangleMesh far = box_mesh(Vec3(0, 0, 3), Vec3(1, 1, 4));
    EXPECT_EQ(scene.add(near.positions, near.triangles), 0);
    EXPECT_EQ(scene.add(far.positions, far.triangles), 1);
    scene.commit();
    const Vec3 origin(0.4, 0.3, 0.0);
    EXPECT_EQ(scene.closest_hit(origin, Vec3::UnitZ(), 100.0)->mesh, 0);

    for (Vec3& x : near.positions)
        x.z() += 5.0;
    scene.update(0, near.positions);
    scene.commit();
    EXPECT_EQ(scene.closest_hit(origin, Vec3::UnitZ(), 100.0)->mesh, 1);
    EXPECT_NEAR(scene.closest_hit(Vec3(0.4, 0.3, 4.5), Vec3::UnitZ(), 100.0)->t, 1.5, 1e-6);
}

TEST(RayScene, CountsWindingsInOverlapsAndInsideOut)
{
    const TriangleMesh ball = sphere_mesh(Vec3::Zero(), 0.5, 3);
    const RayScene scene = scene_of(merged(ball, box_mesh(Vec3(0, -1, -1), Vec3(2, 1, 1))));
    EXPECT_EQ(scene.winding_number(Vec3(-0.3, 0.0, 0.0)), 1);
    EXPECT_EQ(scene.winding_number(Vec3(0.3, 0.0, 0.0)), 2);
    EXPECT_EQ(scene.winding_number(Vec3(1.0, 0.5, 0.5)), 1);
    EXPECT_EQ(scene.winding_number(Vec3(-0.6, 0.0, 0.0)), 0);

    TriangleMesh inverted = ball;
    for (Triangle& t : inverted.triangles)
        std::swap(t[0], t[1]);
    EXPECT_EQ(scene_of(inverted).winding_number(Vec3(0.1, 0.1, 0.1)), -1);
}

TEST(RayScene, WindingSeparatesInsideFromOutsideToAMicrometre)
{
    const RayScene scene = scene_of(box_mesh(Vec3(1.5, 1.5, 1.5), Vec3(2, 2, 2)));
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(1.50001, 1.99999);
    for (int i = 0; i < 2000; ++i) {
        Vec3 point(uniform(random), uniform(random), uniform(random));
        point[i % 3] = 2.0 - 2e-6;
        ASSERT_EQ(scene.winding_number(point), 1) << point.transpose();
        point[i % 3] = 2.0 + 2e-6;
        ASSERT_EQ(scene.winding_number(point), 0) << point.transpose();
    }
}

} // namespace
} // namespace toile::test
