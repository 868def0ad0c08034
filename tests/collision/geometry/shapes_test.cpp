#include "collision/geometry/shapes.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "collision/body/detect.h"
#include "core/base/error.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

Eigen::Isometry3d some_pose()
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Vec3(0.4, 1.1, -0.7));
    pose.rotate(Eigen::AngleAxisd(1.3, Vec3(1, 2, -1).normalized()));
    return pose;
}

/// Signed distance by independent formulas (Inigo Quilez), in the shape's frame.
double signed_distance(const Shape& shape, const Vec3& x)
{
    if (const auto* plane = std::get_if<PlaneShape>(&shape))
        return plane->normal.dot(x);
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return x.norm() - sphere->radius;
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
        const double beyond = std::max(std::abs(x.y()) - capsule->half_length, 0.0);
        return std::sqrt(x.x() * x.x() + x.z() * x.z() + beyond * beyond) - capsule->radius;
    }
    const Vec3 q = x.cwiseAbs() - std::get<BoxShape>(shape).half_extent;
    return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

const std::vector<Shape> kShapes = {PlaneShape{Vec3(1, 2, 2) / 3.0}, SphereShape{0.4},
                                    CapsuleShape{0.3, 0.15}, CapsuleShape{0.0, 0.2},
                                    BoxShape{Vec3(0.3, 0.5, 0.2)}};

TEST(Shapes, ClosestPointLiesOnTheSurfaceAtTheSignedDistance)
{
    std::mt19937 random(20);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const Eigen::Isometry3d pose = some_pose();
    for (const Shape& shape : kShapes)
        for (int i = 0; i < 500; ++i) {
            const Vec3 local(uniform(random), uniform(random), uniform(random));
            const ShapePoint found = closest(shape, pose, pose * local);
            EXPECT_NEAR(found.signed_distance, signed_distance(shape, local), 1e-14);
            EXPECT_NEAR(signed_distance(shape, pose.inverse() * found.point), 0.0, 1e-14);
            EXPECT_NEAR(found.normal.norm(), 1.0, 1e-14);
            EXPECT_LT((pose * local - found.point - found.signed_distance * found.normal).norm(), 1e-14);
        }
}

TEST(Shapes, NormalIsTheGradientOfTheSignedDistance)
{
    std::mt19937 random(21);
    std::uniform_real_distribution<double> uniform(-0.8, 0.8);
    constexpr double h = 1e-7;
    for (const Shape& shape : kShapes)
        for (int i = 0; i < 100; ++i) {
            const Vec3 x(uniform(random), uniform(random), uniform(random));
            const ShapePoint found = closest(shape, Eigen::Isometry3d::Identity(), x);
            for (int k = 0; k < 3; ++k) {
                const Vec3 step = h * Vec3::Unit(k);
                const double slope =
                    (signed_distance(shape, x + step) - signed_distance(shape, x - step)) / (2 * h);
                // Across a medial plane of the box the gradient jumps; random points miss it.
                EXPECT_NEAR(found.normal[k], slope, 1e-5);
            }
        }
}

TEST(Shapes, ChooseAFixedNormalAtAmbiguousPoints)
{
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    EXPECT_EQ(closest(SphereShape{0.5}, pose, Vec3::Zero()).normal, Vec3::UnitY());
    EXPECT_EQ(closest(CapsuleShape{0.5, 0.1}, pose, Vec3(0, 0.2, 0)).normal, Vec3::UnitX());
    EXPECT_EQ(closest(BoxShape{Vec3::Constant(0.5)}, pose, Vec3::Zero()).normal, Vec3::UnitX());
    EXPECT_EQ(closest(BoxShape{Vec3::Constant(0.5)}, pose, Vec3::Zero()).signed_distance, -0.5);
}

TEST(Shapes, RefuseSizesThatMakeNoSolid)
{
    const double inf = std::numeric_limits<double>::infinity();
    for (const Shape& shape : std::vector<Shape>{
             SphereShape{0.0}, SphereShape{inf}, CapsuleShape{-0.1, 0.1}, CapsuleShape{0.1, 0.0},
             BoxShape{Vec3(1, 0, 1)}, PlaneShape{Vec3(0, 2, 0)}, PlaneShape{Vec3::Constant(std::nan(""))}})
        try {
            require_usable(shape, "scene.json: avatars[2]");
            ADD_FAILURE() << "shape " << shape.index() << " was accepted";
        } catch (const InvalidInput& error) {
            EXPECT_NE(std::string(error.what()).find("scene.json: avatars[2]"), std::string::npos);
        }
    EXPECT_NO_THROW(require_usable(CapsuleShape{0.0, 0.1}, "x"));
}

TEST(ShapeCollider, MovesItsSurfacePointsRigidly)
{
    ShapeCollider ball(SphereShape{0.5}, Eigen::Isometry3d::Identity(), "ball");
    EXPECT_EQ(ball.motion(Vec3(0.5, 0, 0)).norm(), 0.0);
    Eigen::Isometry3d rotated = Eigen::Isometry3d::Identity();
    rotated.translate(Vec3(0, 1, 0));
    rotated.rotate(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitZ()));
    ball.move(Eigen::Isometry3d::Identity(), rotated);
    // The point (0, 1.5, 0) at t1 was (0.5, 0, 0) at t0.
    EXPECT_LT((ball.motion(Vec3(0, 1.5, 0)) - Vec3(-0.5, 1.5, 0)).norm(), 1e-14);
    EXPECT_NEAR(ball.closest(Vec3(0, 2, 0)).signed_distance, 0.5, 1e-14);
}

TEST(ShapeCollider, MakesAPairOfEveryClothVertexWithinTheRadius)
{
    ShapeCollider ball(SphereShape{0.2}, Eigen::Isometry3d::Identity(), "ball");
    Eigen::Isometry3d lifted = Eigen::Isometry3d::Identity();
    lifted.translate(Vec3(0, 0.1, 0));
    ball.move(Eigen::Isometry3d::Identity(), lifted);
    const TriangleMesh cloth = testing::sheet_mesh(0.5, 20, 0.29);
    ContactDetector detector(cloth.triangles, cloth.positions);
    std::vector<ContactPair> pairs;
    detector.detect(ball, 7, {}, pairs);
    size_t expected = 0;
    for (const Vec3& x : cloth.positions)
        expected += (x - Vec3(0, 0.1, 0)).norm() - 0.2 < 0.01;
    EXPECT_EQ(pairs.size(), expected);
    EXPECT_GT(expected, 20u);
    for (const ContactPair& pair : pairs) {
        EXPECT_EQ(pair.kind, ContactKind::kVertexShape);
        EXPECT_EQ(pair.collider, 7);
        EXPECT_NEAR(pair.gap(cloth.positions),
                    (cloth.positions[pair.vertex[0]] - Vec3(0, 0.1, 0)).norm() - 0.2, 1e-12);
        EXPECT_LT((pair.motion - Vec3(0, 0.1, 0)).norm(), 1e-14);
    }
}

} // namespace
} // namespace toile::test
