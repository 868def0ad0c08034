#include "collision/check/penetration.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "tests/collision/shapes_for_tests.h"

namespace toile::test {

using namespace collision;

namespace {

using testing::box_mesh;
using testing::merged;
using testing::sheet_mesh;
using testing::sphere_mesh;

PenetrationMeter meter_of(const TriangleMesh& mesh) { return {mesh.triangles, mesh.positions}; }

TEST(Penetration, IsTheDepthOfABallPressedIntoABlock)
{
    const PenetrationMeter block = meter_of(subdivide(box_mesh(Vec3(-1, -1, -1), Vec3(1, 0, 1)), 3));
    const TriangleMesh ball = sphere_mesh(Vec3(0.1, 0.18, 0.05), 0.2, 3);
    const Penetration found = block.measure(ball.positions);
    EXPECT_NEAR(found.max_depth, 0.02, 1e-12);
    EXPECT_LT((found.point - Vec3(0.1, -0.02, 0.05)).norm(), 1e-12);
    EXPECT_EQ(ball.positions[found.sample], found.point);
    EXPECT_EQ(found.excluded_count, 0);
    EXPECT_EQ(block.measure(sphere_mesh(Vec3(0.1, 0.21, 0.05), 0.2, 3).positions).max_depth, 0.0);
    EXPECT_EQ(block.measure(sphere_mesh(Vec3(0.1, 0.21, 0.05), 0.2, 3).positions).sample, -1);
}

TEST(Penetration, FindsATipThroughACoarseFace)
{
    const PenetrationMeter ball = meter_of(sphere_mesh(Vec3::Zero(), 0.2, 4));
    const TriangleMesh cloth = {{{-1, 0.17, -1}, {1, 0.17, -1}, {0, 0.17, 2}}, {{0, 2, 1}}};
    EXPECT_EQ(ball.measure(cloth.positions).max_depth, 0.0);
    const ClothSamples samples(cloth.triangles, cloth.vertex_count());
    const Penetration found = ball.measure(samples.at(cloth.positions));
    EXPECT_NEAR(found.max_depth, 0.03, 1e-3);
    EXPECT_EQ(samples.name(found.sample), "triangle 0");
    EXPECT_EQ(samples.name(0), "vertex 0");
    EXPECT_EQ(samples.name(5), "edge 0-2");
    EXPECT_EQ(samples.at(cloth.positions)[5], Vec3(-0.5, 0.17, 0.5));
}

/// Two blocks that overlap between x = -0.05 and 0.05, like an arm pressed into a flank.
TriangleMesh overlapping_blocks()
{
    return merged(subdivide(box_mesh(Vec3(-0.5, -0.5, -0.5), Vec3(0.05, 0.5, 0.5)), 4),
                  subdivide(box_mesh(Vec3(-0.05, -0.5, -0.5), Vec3(0.5, 0.45, 0.5)), 4));
}

TEST(Penetration, ExcludesSelfIntersectionsOfTheBody)
{
    const PenetrationMeter body = meter_of(overlapping_blocks());
    const auto measure_at = [&](const Vec3& p) { return body.measure(std::vector<Vec3>{p}); };

    const Penetration in_both = measure_at(Vec3(0.01, 0.0, 0.0));
    EXPECT_EQ(in_both.max_depth, 0.0);
    EXPECT_EQ(in_both.excluded_count, 1);
    EXPECT_NEAR(in_both.deepest_excluded, 0.04, 1e-9);

    // Inside the left block only; its nearest surface is the right block's buried face.
    EXPECT_EQ(measure_at(Vec3(-0.1, 0.0, 0.0)).excluded_count, 1);

    // Just below the free top, far from the overlap: counted.
    const Penetration free = measure_at(Vec3(-0.3, 0.48, 0.0));
    EXPECT_EQ(free.excluded_count, 0);
    EXPECT_NEAR(free.max_depth, 0.02, 1e-9);
    EXPECT_EQ(measure_at(Vec3(-0.7, 0.0, 0.0)).excluded_count, 0);
}

TEST(Penetration, ExcludesWithinTheMarginOfASelfIntersectionOnly)
{
    const TriangleMesh blocks = overlapping_blocks();
    // Below the right block's top, beside the left block's flank at x = 0.05, whose buried part ends 1 mm
    // lower.
    const auto excluded = [&](double x, double margin) {
        const PenetrationMeter body(blocks.triangles, blocks.positions, {.pinch_margin = margin});
        return body.measure(std::vector<Vec3>{Vec3(x, 0.449, 0.0)}).excluded_count == 1;
    };
    EXPECT_TRUE(excluded(0.055, 0.01));
    EXPECT_FALSE(excluded(0.2, 0.01));
    EXPECT_TRUE(excluded(0.2, 0.16));
}

TEST(Penetration, CallsPartsThatFaceEachOtherWithinTheRoomPinched)
{
    TriangleMesh blocks = subdivide(box_mesh(Vec3(-1, -1, -1), Vec3(-0.001, 0, 1)), 4);
    const TriangleMesh right = subdivide(box_mesh(Vec3(0.001, -1, -1), Vec3(1, 0, 1)), 4);
    const int first = blocks.vertex_count();
    blocks.positions.insert(blocks.positions.end(), right.positions.begin(), right.positions.end());
    for (const Triangle& t : right.triangles)
        blocks.triangles.push_back(t + Triangle::Constant(first));
    const auto pinched = [&](double room, const Vec3& at) {
        return PenetrationMeter(blocks.triangles, blocks.positions, {.room = room}).is_pinched(at, {});
    };
    EXPECT_TRUE(pinched(0.003, Vec3(0.0, -0.5, 0.0)));
    EXPECT_FALSE(pinched(0.001, Vec3(0.0, -0.5, 0.0))) << "2 mm are room enough";
    EXPECT_FALSE(pinched(0.003, Vec3(-0.5, 0.0, 0.0))) << "on top, far from the slit";
}

TEST(Penetration, FollowsTheMesh)
{
    TriangleMesh mesh = subdivide(box_mesh(Vec3(-1, -1, -1), Vec3(1, 0, 1)), 2);
    PenetrationMeter block = meter_of(mesh);
    for (Vec3& x : mesh.positions)
        x.y() += 0.5;
    block.move(mesh.positions);
    EXPECT_NEAR(block.measure(std::vector<Vec3>{{0, 0.47, 0}}).max_depth, 0.03, 1e-12);
    EXPECT_EQ(block.measure(std::vector<Vec3>{{0, 0.53, 0}}).max_depth, 0.0);
}

TEST(Penetration, OfAnOpenSheetIsAChangeOfSides)
{
    const PenetrationMeter sheet = meter_of(sheet_mesh(1.0, 10, 0.0));
    const Vec3 above(0.13, 0.02, 0.11), below(0.13, -0.02, 0.11);
    const auto depth = [&](const std::vector<Vec3>& way) {
        PenetrationMeter::Sides sides;
        double last = 0.0;
        for (const Vec3& p : way)
            last = sheet.measure(std::vector<Vec3>{p}, &sides).max_depth;
        return last;
    };
    EXPECT_EQ(depth({above, above}), 0.0);
    EXPECT_EQ(depth({below, below}), 0.0) << "either side is outside";
    EXPECT_NEAR(depth({above, below}), 0.02, 1e-12);
    EXPECT_NEAR(depth({below, above}), 0.02, 1e-12);
    EXPECT_EQ(depth({above, below, above}), 0.0) << "it has come back";
    EXPECT_EQ(depth({above, Vec3(0.51, -0.02, 0.11), below}), 0.0) << "around the border";
    EXPECT_EQ(depth({above, Vec3(0.13, 0.2, 0.11), below}), 0.0) << "not near in between";
}

TEST(Penetration, SkipsNonFiniteVertices)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Vec3> samples{{0.1, -0.02, 0.1}, {nan, 0.0, 0.0}, {0.0, -HUGE_VAL, 0.0}};
    PenetrationMeter::Sides sides(samples.size(), 1);
    EXPECT_NEAR(meter_of(sheet_mesh(1.0, 10, 0.0)).measure(samples, &sides).max_depth, 0.02, 1e-12);
    const PenetrationMeter block = meter_of(subdivide(box_mesh(Vec3(-1, -1, -1), Vec3(1, 0, 1)), 1));
    EXPECT_NEAR(block.measure(samples).max_depth, 0.02, 1e-12);
}

TEST(Penetration, IsTheSameForEveryThreadCount)
{
    const TriangleMesh body =
        merged(sphere_mesh(Vec3(0, 0, 0), 0.2, 4), sphere_mesh(Vec3(0.25, 0, 0), 0.15, 4));
    const TriangleMesh cloth = sheet_mesh(1.0, 60, 0.1);
    Penetration reference;
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const Penetration found = meter_of(body).measure(cloth.positions);
        if (threads == 1)
            reference = found;
        EXPECT_GT(found.max_depth, 0.05);
        EXPECT_GT(found.excluded_count, 0);
        EXPECT_EQ(found.max_depth, reference.max_depth);
        EXPECT_EQ(found.sample, reference.sample);
        EXPECT_EQ(found.excluded_count, reference.excluded_count);
    }
}

} // namespace
} // namespace toile::test
