#include "collision/body/shape_search.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/check/penetration.h"
#include "core/base/stages.h"
#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::sheet_mesh;

Eigen::Isometry3d pose_of(const Vec3& position, double angle, const Vec3& axis)
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(position);
    pose.rotate(Eigen::AngleAxisd(angle, axis.normalized()));
    return pose;
}

std::vector<ContactPair> pairs_of(const TriangleMesh& cloth, const ShapeCollider& shape,
                                  const DetectSettings& settings = {})
{
    ContactDetector detector(cloth.triangles, cloth.positions);
    std::vector<ContactPair> pairs;
    detector.detect(shape, 3, settings, pairs);
    return pairs;
}

size_t count(const std::vector<ContactPair>& pairs, ContactKind kind)
{
    return size_t(std::count_if(pairs.begin(), pairs.end(),
                                [&](const ContactPair& pair) { return pair.kind == kind; }));
}

/// One triangle of two metres in the plane y = height, normal up, the origin well inside.
TriangleMesh large_triangle(double height)
{
    return {{{-1, height, -1}, {0, height, 2}, {1, height, -1}}, {{0, 1, 2}}};
}

TEST(ShapeSkeleton, HasTheSignedDistanceOfItsSolid)
{
    const Eigen::Isometry3d pose = pose_of(Vec3(0.2, 0.1, -0.3), 0.8, Vec3(1, 2, 3));
    const Shape capsule = CapsuleShape{0.3, 0.1};
    const ShapeSkeleton skeleton = skeleton_of(capsule, pose);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int i = 0; i < 200; ++i) {
        const Vec3 x(uniform(random), uniform(random), uniform(random));
        EXPECT_NEAR(skeleton.distance(x), closest(capsule, pose, x).signed_distance, 1e-14);
    }
    const ShapeSkeleton box = skeleton_of(BoxShape{Vec3(0.1, 0.2, 0.3)}, Eigen::Isometry3d::Identity());
    EXPECT_EQ(box.corners.size(), 8u);
    EXPECT_EQ(box.edges.size(), 12u);
    EXPECT_NEAR(box.distance(Vec3(0, 0.2, 0)), 0.1, 1e-15);
    for (const ShapeSkeleton::Edge& edge : box.edges)
        for (const Vec3& face : edge.faces) {
            EXPECT_NEAR(face.dot(edge.b - edge.a), 0.0, 1e-15);
            EXPECT_GT(face.dot(edge.a), 0.0);
        }
}

/// Share of the pair of an edge that lies across a post and is nearer to it than its vertices; 0: no pair.
double share_across_a_post(double nearer)
{
    const double radius = 0.03, y = radius + 0.001;
    const double half = std::sqrt((y + nearer) * (y + nearer) - y * y);
    const ShapeCollider post(CapsuleShape{0.3, radius},
                             pose_of(Vec3::Zero(), 0.5 * std::acos(-1.0), Vec3::UnitX()), "post");
    const TriangleMesh cloth{{{-half, y, 0.0}, {half, y, 0.0}, {0.0, y + 0.2, 0.0}}, {{0, 1, 2}}};
    for (const ContactPair& pair : pairs_of(cloth, post))
        if (pair.kind == ContactKind::kEdgeShape)
            return pair.share;
    return 0.0;
}

TEST(ShapeSearch, LetsPairsOfRoundShapesGrowFromNothing)
{
    EXPECT_EQ(share_across_a_post(0.99e-4), 0.0);
    EXPECT_NEAR(share_across_a_post(1.01e-4), 0.01, 1e-6);
    EXPECT_NEAR(share_across_a_post(1.5e-4), 0.5, 1e-6);
    EXPECT_EQ(share_across_a_post(2.1e-4), 1.0);
}

TEST(ShapeSearch, FindsABallUnderOneFace)
{
    const ShapeCollider ball(SphereShape{0.03}, Eigen::Isometry3d::Identity(), "ball");
    for (const double gap : {0.005, 0.0, -0.02}) {
        const TriangleMesh cloth = large_triangle(0.03 + gap);
        const std::vector<ContactPair> pairs = pairs_of(cloth, ball);
        ASSERT_EQ(pairs.size(), 1u);
        EXPECT_EQ(pairs[0].kind, ContactKind::kFaceShape);
        EXPECT_LT((pairs[0].normal - Vec3::UnitY()).norm(), 1e-12);
        EXPECT_NEAR(pairs[0].gap(cloth.positions), gap, 1e-12);
        EXPECT_EQ(pairs[0].collider, 3);
    }
    EXPECT_TRUE(pairs_of(large_triangle(0.041), ball).empty());
}

TEST(ShapeSearch, FindsBothEndsOfALyingCapsuleUnderOneFace)
{
    const ShapeCollider capsule(CapsuleShape{0.1, 0.02}, pose_of(Vec3::Zero(), M_PI / 2, Vec3::UnitX()),
                                "capsule");
    const std::vector<ContactPair> pairs = pairs_of(large_triangle(0.025), capsule);
    EXPECT_EQ(count(pairs, ContactKind::kFaceShape), 2u);
    EXPECT_EQ(pairs.size(), 2u);
}

TEST(ShapeSearch, FindsAnEdgeAcrossACapsule)
{
    const ShapeCollider capsule(CapsuleShape{0.3, 0.02}, pose_of(Vec3::Zero(), M_PI / 2, Vec3::UnitZ()),
                                "capsule");
    // A ridge of cloth along z crosses above the capsule, which lies along x; faces fall away on both sides.
    const TriangleMesh roof = {{{0, 0.021, -0.1}, {0, 0.021, 0.1}, {0.1, 0.2, 0}, {-0.1, 0.2, 0}},
                               {{0, 1, 2}, {0, 3, 1}}};
    const std::vector<ContactPair> pairs = pairs_of(roof, capsule);
    ASSERT_EQ(count(pairs, ContactKind::kEdgeShape), 1u);
    EXPECT_NEAR(pairs[0].gap(roof.positions), 0.001, 1e-14);
    EXPECT_LT((pairs[0].normal - Vec3::UnitY()).norm(), 1e-14);
}

TEST(ShapeSearch, FindsAllFourCornersUnderAFaceThatLiesOnABox)
{
    const ShapeCollider box(BoxShape{Vec3(0.05, 0.02, 0.04)}, Eigen::Isometry3d::Identity(), "box");
    for (const double gap : {0.004, 0.0, -0.004}) {
        const TriangleMesh cloth = large_triangle(0.02 + gap);
        const std::vector<ContactPair> pairs = pairs_of(cloth, box);
        EXPECT_EQ(count(pairs, ContactKind::kFaceShape), 4u);
        for (const ContactPair& pair : pairs) {
            EXPECT_LT((pair.normal - Vec3::UnitY()).norm(), 1e-12);
            EXPECT_NEAR(pair.gap(cloth.positions), gap, 1e-12);
        }
    }
    // Cloth below the box is pushed down, and not through a plate by the corners of its far side.
    const std::vector<ContactPair> below = pairs_of(large_triangle(-0.025), box, {.radius = 0.06});
    EXPECT_EQ(count(below, ContactKind::kFaceShape), 4u);
    for (const ContactPair& pair : below)
        EXPECT_LT((pair.normal + Vec3::UnitY()).norm(), 1e-12);
}

TEST(ShapeSearch, FindsAnEdgeAcrossTheRimOfABox)
{
    const ShapeCollider box(BoxShape{Vec3(0.1, 0.1, 0.1)}, Eigen::Isometry3d::Identity(), "box");
    // The line x + y = 0.2 + shift in the plane z = 0 runs across the rim at (0.1, 0.1).
    for (const double gap : {0.003, -0.003}) {
        const double shift = gap * std::sqrt(2.0);
        const TriangleMesh cloth = {
            {{0.3 + shift, -0.1, 0}, {-0.1 + shift, 0.3, 0}, {0.5, 0.5, 0.5}, {0.5, 0.5, -0.5}},
            {{0, 1, 2}, {1, 0, 3}}};
        const std::vector<ContactPair> pairs = pairs_of(cloth, box);
        ASSERT_EQ(count(pairs, ContactKind::kEdgeShape), 1u);
        EXPECT_LT((pairs[0].normal - Vec3(1, 1, 0).normalized()).norm(), 1e-12);
        EXPECT_NEAR(pairs[0].gap(cloth.positions), gap, 1e-12);
    }
}

/// A sheet above a rotated solid or through it is pushed out pair by pair, repeatedly. The pairs alone must
/// clear the cloth.
TEST(ShapeSearch, ClearsCoarseClothOfEverySolidInAnyPose)
{
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const std::vector<Shape> shapes = {SphereShape{0.05}, CapsuleShape{0.1, 0.03},
                                       BoxShape{Vec3(0.06, 0.04, 0.08)}};
    for (int trial = 0; trial < 60; ++trial) {
        const Shape& shape = shapes[size_t(trial) % shapes.size()];
        const Eigen::Isometry3d pose =
            pose_of(Vec3(0.1 * uniform(random), 0.0, 0.1 * uniform(random)), 3.0 * uniform(random),
                    Vec3(uniform(random), uniform(random), uniform(random)));
        // The highest point of the solid stands 8 mm above the sheet.
        double top = 0.0;
        for (const Vec3& p : skeleton_of(shape, pose).points())
            top = std::max(top, p.y());
        TriangleMesh cloth = sheet_mesh(1.2, 4, top + skeleton_of(shape, pose).radius - 0.008);
        const ShapeCollider collider(shape, pose, "solid");
        for (int pass = 0; pass < 60; ++pass)
            for (const ContactPair& pair : pairs_of(cloth, collider)) {
                const double depth = 0.001 - pair.gap(cloth.positions);
                double squares = 0.0;
                for (const double weight : pair.weight)
                    squares += weight * weight;
                for (int k = 0; k < 3 && pair.vertex[k] >= 0 && depth > 0.0; ++k)
                    cloth.positions[pair.vertex[k]] += pair.weight[k] / squares * depth * pair.normal;
            }
        double deepest = 0.0;
        for (const Triangle& t : cloth.triangles)
            deepest =
                std::max(deepest, penetration_of_triangle(shape, pose, cloth.positions[t[0]],
                                                          cloth.positions[t[1]], cloth.positions[t[2]]));
        EXPECT_LT(deepest, 1e-4) << "trial " << trial;
    }
}

TEST(ShapeSearch, MakesOnlyVertexPairsForFineClothOnARoundShape)
{
    const ShapeCollider ball(SphereShape{0.3}, Eigen::Isometry3d::Identity(), "ball");
    const std::vector<ContactPair> pairs = pairs_of(sheet_mesh(0.2, 30, 0.301), ball);
    EXPECT_GT(pairs.size(), 100u);
    EXPECT_EQ(count(pairs, ContactKind::kVertexShape), pairs.size());
}

TEST(ShapeSearch, NeverRunsForPlanesAndDistantSolids)
{
    const TriangleMesh cloth = sheet_mesh(0.5, 4, 0.001);
    const ShapeCollider plane(PlaneShape{}, Eigen::Isometry3d::Identity(), "floor");
    const ShapeCollider far(BoxShape{}, pose_of(Vec3(0, -2, 0), 0.0, Vec3::UnitX()), "far");
    Stages stages;
    const Stages::Activate recording(stages);
    EXPECT_EQ(pairs_of(cloth, plane).size(), cloth.positions.size());
    EXPECT_TRUE(pairs_of(cloth, far).empty());
    for (const char* stage : {"collision/shape_distance", "collision/shape_faces", "collision/shape_edges"})
        EXPECT_EQ(stages.calls(stage), 0) << stage;
    pairs_of(cloth, ShapeCollider(SphereShape{0.1}, Eigen::Isometry3d::Identity(), "ball"));
    EXPECT_EQ(stages.calls("collision/shape_faces"), 1);
}

TEST(PenetrationOfTriangle, IsThePenetrationOfItsDeepestPoint)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    const std::vector<Shape> shapes = {SphereShape{0.3}, CapsuleShape{0.3, 0.2},
                                       BoxShape{Vec3(0.3, 0.2, 0.4)}, PlaneShape{}};
    constexpr int kSteps = 60;
    for (int trial = 0; trial < 40; ++trial) {
        const Shape& shape = shapes[size_t(trial) % shapes.size()];
        const Eigen::Isometry3d pose = pose_of(0.2 * point(), 3.0 * uniform(random), point());
        const Vec3 a = point(), b = point(), c = point();
        double sampled = 0.0;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; i + j <= kSteps; ++j)
                sampled = std::max(
                    sampled,
                    -closest(shape, pose, a + i * (b - a) / kSteps + j * (c - a) / kSteps).signed_distance);
        const double found = penetration_of_triangle(shape, pose, a, b, c);
        EXPECT_GE(found, sampled - 2e-7);
        EXPECT_LE(found, sampled + 0.05); // samples are up to 5 cm apart
    }
    // A corner of a cube on its tip pierces a large triangle by 1 cm: depth / sqrt(3) from each of its faces.
    Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
    tip.rotate(Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitY()));
    const TriangleMesh cloth = large_triangle(0.1 * std::sqrt(3.0) - 0.01);
    EXPECT_NEAR(penetration_of_triangle(BoxShape{Vec3::Constant(0.1)}, tip, cloth.positions[0],
                                        cloth.positions[1], cloth.positions[2]),
                0.01 / std::sqrt(3.0), 1e-6);
}

} // namespace
} // namespace toile::test
