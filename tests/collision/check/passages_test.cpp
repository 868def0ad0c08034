#include "collision/check/passages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::sheet_mesh;
using testing::sphere_mesh;

/// The y axis of a shape along z.
Eigen::Isometry3d at(const Vec3& p)
{
    return Eigen::Translation3d(p) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX());
}

std::vector<Vec3> moved(std::vector<Vec3> x, const Vec3& by)
{
    for (Vec3& p : x)
        p += by;
    return x;
}

/// A sheet of 40 cm, 2 cm cells, in the plane y = height.
TriangleMesh sheet(double height) { return sheet_mesh(0.4, 20, height); }

TEST(Passages, AreFoundWhereAShapeGoesThrough)
{
    const TriangleMesh cloth = sheet(0.0);
    const ClothSamples samples(cloth.triangles, cloth.vertex_count());
    const ClothFrames still(samples, cloth.positions, cloth.positions);
    for (const Shape& shape :
         {Shape(SphereShape{0.04}), Shape(CapsuleShape{0.2, 0.04}), Shape(BoxShape{Vec3(0.1, 0.1, 0.01)})}) {
        const std::vector<Passage> found =
            find_passages(still, shape, at(Vec3(0, 0.1, 0)), at(Vec3(0, -0.15, 0)));
        EXPECT_GT(found.size(), 4u) << shape.index();
        for (const Passage& passage : found)
            EXPECT_LT(std::abs(passage.point.y() - 0.1), 0.02) << shape.index();
        EXPECT_TRUE(find_passages(still, shape, at(Vec3(0, 0.1, 0)), at(Vec3(0, 0.06, 0))).empty());
    }
}

TEST(Passages, AreFoundWhereAMeshGoesThrough)
{
    const TriangleMesh cloth = sheet(0.0);
    const TriangleMesh ball = sphere_mesh(Vec3(0, 0.1, 0), 0.04, 3);
    const PenetrationMeter meter(ball.triangles, ball.positions);
    const ClothSamples samples(cloth.triangles, cloth.vertex_count());
    const ClothFrames still(samples, cloth.positions, cloth.positions);
    EXPECT_GT(find_passages(still, meter, moved(ball.positions, Vec3(0, -0.25, 0))).size(), 4u);
    EXPECT_TRUE(find_passages(still, meter, moved(ball.positions, Vec3(0, -0.05, 0))).empty());

    // Cloth that goes along, and cloth that falls through.
    const std::vector<Vec3> along = moved(cloth.positions, Vec3(0, -0.25, 0));
    EXPECT_TRUE(
        find_passages({samples, cloth.positions, along}, meter, moved(ball.positions, Vec3(0, -0.25, 0)))
            .empty());
    const std::vector<Vec3> above = moved(cloth.positions, Vec3(0, 0.2, 0));
    EXPECT_GT(find_passages({samples, above, cloth.positions}, meter, ball.positions).size(), 4u);
}

TEST(Passages, AreNotWhereClothSlidesAroundARod)
{
    // Hangs over a rod of 1 cm, half of it on each side, and is pulled over it by 3 cm.
    const auto hanging = [](double pulled) {
        TriangleMesh cloth = sheet(0.0);
        for (Vec3& p : cloth.positions) {
            const double s = p.x() + pulled, radius = 0.011, quarter = 0.5 * std::numbers::pi * radius;
            if (std::abs(s) < quarter)
                p = Vec3(radius * std::sin(s / radius), radius * std::cos(s / radius), p.z());
            else
                p = Vec3(std::copysign(radius, s), quarter - std::abs(s), p.z());
        }
        return cloth;
    };
    const TriangleMesh before = hanging(0.0), after = hanging(0.03);
    const ClothSamples samples(before.triangles, before.vertex_count());
    const Eigen::Isometry3d rod = at(Vec3::Zero());
    EXPECT_TRUE(find_passages({samples, before.positions, after.positions}, CapsuleShape{0.5, 0.01}, rod, rod)
                    .empty());
}

TEST(Passages, AreNotWhereATipGoesAroundAnEdge)
{
    // A needle under a plate, whose tip comes up beside it; the straight path leads through the plate's edge.
    // Rays beside the path meet the needle twice within micrometres of its tip.
    TriangleMesh needle;
    needle.positions = {Vec3(0, -0.02, 0), Vec3(0.03, -0.05, 0.02), Vec3(-0.03, -0.05, 0.02),
                        Vec3(0, -0.05, -0.03)};
    needle.triangles = {Triangle(0, 1, 3), Triangle(0, 2, 1), Triangle(0, 3, 2), Triangle(1, 2, 3)};
    const ClothSamples samples(needle.triangles, needle.vertex_count());
    const BoxShape plate{Vec3(0.05, 0.01, 0.1)};
    const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
    int paths = 0;
    for (double x = -0.045; x < 0.05; x += 0.003) {
        const std::vector<Vec3> below = moved(needle.positions, Vec3(x, 0, 0));
        const std::vector<Vec3> above = moved(needle.positions, Vec3(x + 0.012, 0.08, 0));
        EXPECT_TRUE(find_passages({samples, below, above}, plate, still, still).empty()) << x;
        ++paths;
    }
    EXPECT_GT(paths, 30);
}

TEST(Passages, AreFoundWhereALimbLeavesItsSleeve)
{
    // A ball in a wide sleeve of cloth, which jumps out to the side.
    const TriangleMesh ball = sphere_mesh(Vec3::Zero(), 0.05, 3);
    TriangleMesh sleeve = sheet(0.0);
    for (Vec3& p : sleeve.positions) {
        const double angle = 2.0 * std::numbers::pi * (p.x() + 0.2) / 0.401;
        p = Vec3(0.08 * std::cos(angle), 0.08 * std::sin(angle), p.z());
    }
    const PenetrationMeter meter(ball.triangles, ball.positions);
    const ClothSamples samples(sleeve.triangles, sleeve.vertex_count());
    const ClothFrames still(samples, sleeve.positions, sleeve.positions);
    EXPECT_GT(find_passages(still, meter, moved(ball.positions, Vec3(0, 0.25, 0))).size(), 4u);
    EXPECT_GT(find_passages(still, SphereShape{0.05}, at(Vec3::Zero()), at(Vec3(0, 0.25, 0))).size(), 4u);
    EXPECT_TRUE(find_passages(still, meter, moved(ball.positions, Vec3(0, 0.02, 0))).empty());
}

TEST(Passages, AreFoundThroughAnOpenMesh)
{
    const TriangleMesh plate = sheet_mesh(0.2, 4, 0.1), cloth = sheet(0.0);
    const PenetrationMeter meter(plate.triangles, plate.positions);
    const ClothSamples samples(cloth.triangles, cloth.vertex_count());
    const ClothFrames still(samples, cloth.positions, cloth.positions);
    EXPECT_GT(find_passages(still, meter, moved(plate.positions, Vec3(0, -0.3, 0))).size(), 20u);
    EXPECT_TRUE(find_passages(still, meter, moved(plate.positions, Vec3(0, -0.05, 0))).empty());
}

TEST(Passages, AreNotWhereABodyTurns)
{
    // A cap of cloth on an arm that swings by a right angle about its end, and so through where it was not.
    const TriangleMesh arm = sphere_mesh(Vec3(0.3, 0, 0), 0.05, 3);
    TriangleMesh cap = sphere_mesh(Vec3(0.3, 0, 0), 0.052, 3);
    std::erase_if(cap.triangles, [&](const Triangle& t) { return cap.positions[t[0]].x() < 0.3; });
    const Eigen::AngleAxisd turn(0.5 * std::numbers::pi, Vec3::UnitZ());
    std::vector<Vec3> arm1 = arm.positions, cap1 = cap.positions;
    for (std::vector<Vec3>* x : {&arm1, &cap1})
        for (Vec3& p : *x)
            p = turn * p;
    const PenetrationMeter meter(arm.triangles, arm.positions);
    const ClothSamples samples(cap.triangles, cap.vertex_count());
    EXPECT_TRUE(find_passages({samples, cap.positions, cap1}, meter, arm1).empty());
    EXPECT_FALSE(find_passages({samples, cap.positions, moved(cap1, Vec3(0, -0.2, 0))}, meter, arm1).empty())
        << "pulled off through the arm";
}

} // namespace
} // namespace toile::test
