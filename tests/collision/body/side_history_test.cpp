#include "collision/body/side_history.h"

#include <gtest/gtest.h>

#include "collision/body/detect.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

/// Box of height 4 cm with its top at y = 0, cut into small triangles.
TriangleMesh box() { return subdivide(testing::box_mesh({-0.1, -0.04, -0.1}, {0.1, 0.0, 0.1}), 3); }

/// Translates the mesh by `by` in a step.
void move(MeshCollider& collider, MovingMesh& mesh, const Vec3& by)
{
    mesh.x_t0 = mesh.x_t1;
    for (Vec3& x : mesh.x_t1)
        x += by;
    collider.move(mesh);
}

class ContactSideHistoryTest : public ::testing::Test {
protected:
    void update() { sides_.update(above_, collider_, 0, Clearance(1)); }

    MovingMesh mesh_{box().triangles, box().positions, box().positions};
    MeshCollider collider_{mesh_};
    ContactSideHistory sides_{1};
    const std::vector<Vec3> above_{Vec3(0.013, 0.005, 0.007)};
    std::vector<SurfacePoint> found_;
};

TEST_F(ContactSideHistoryTest, RecordsNothingForAStaticMesh)
{
    update();
    sides_.find_behind(0, Vec3(0.013, -0.01, 0.007), collider_, 0, 1.0, found_);
    EXPECT_TRUE(found_.empty());
}

TEST_F(ContactSideHistoryTest, LeadsBackThroughTheCrossedFace)
{
    move(collider_, mesh_, Vec3(0.0, 1e-4, 0.0));
    update();
    move(collider_, mesh_, Vec3(0.0, 0.035, 0.0)); // 3 cm deep: the far side is nearer
    sides_.find_behind(0, above_[0], collider_, 0, 1.0, found_);
    ASSERT_EQ(found_.size(), 1u);
    EXPECT_NEAR(found_[0].signed_distance, -0.0301, 1e-12);

    ContactDetector detector(std::vector<Triangle>{}, above_);
    for (const bool remembers : {false, true}) {
        std::vector<ContactPair> pairs;
        detector.detect(collider_, 0, {}, pairs, remembers ? &sides_ : nullptr);
        ASSERT_EQ(pairs.size(), 1u);
        EXPECT_NEAR(pairs[0].normal.y(), remembers ? 1.0 : -1.0, 1e-12);
    }

    // The side is still known after the step, unless the mesh was repositioned in it.
    update();
    sides_.find_behind(0, above_[0], collider_, 0, 1.0, found_);
    EXPECT_EQ(found_.size(), 1u);
    sides_.find_behind(0, above_[0], collider_, 0, 0.01, found_);
    EXPECT_TRUE(found_.empty());
    sides_.forget();
    sides_.find_behind(0, above_[0], collider_, 0, 1.0, found_);
    EXPECT_TRUE(found_.empty());
}

TEST_F(ContactSideHistoryTest, FollowsClothAroundAnEdge)
{
    // From the top over the edge to the side: always in front of the surface.
    move(collider_, mesh_, Vec3(0.0, 1e-4, 0.0));
    std::vector<Vec3> x{Vec3(0.095, 0.005, 0.0)};
    for (int step = 0; step < 20; ++step) {
        x[0] += step < 10 ? Vec3(0.001, 0.0, 0.0) : Vec3(0.0, -0.002, 0.0);
        sides_.find_behind(0, x[0], collider_, 0, 1.0, found_);
        EXPECT_TRUE(found_.empty()) << step;
        sides_.update(x, collider_, 0, Clearance(1));
    }
}

TEST(ClosestFrom, WalksToTheNearestPointOfItsOwnSheet)
{
    const TriangleMesh two =
        testing::merged(testing::sphere_mesh({0, 0, 0}, 0.1, 3), testing::sphere_mesh({0.25, 0, 0}, 0.1, 3));
    const SurfaceProximity surface(two.triangles, two.positions);
    const int half = two.triangle_count() / 2;
    const Vec3 p(0.131, 0.012, 0.023); // nearer to the second
    const SurfacePoint nearest = *surface.closest(p);
    EXPECT_GE(nearest.triangle, half);
    for (const int start : {half, half + 100, 2 * half - 1})
        EXPECT_NEAR(surface.closest_from(p, start).signed_distance, nearest.signed_distance, 1e-15);
    const SurfaceProximity first(View<const Triangle>(two.triangles).subview(0, half), two.positions);
    for (const int start : {0, 100, half - 1})
        EXPECT_NEAR(surface.closest_from(p, start).signed_distance, first.closest(p)->signed_distance, 1e-15);
}

} // namespace
} // namespace toile::test
