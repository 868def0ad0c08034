#include "collision/bvh/motion_bounds.h"

#include <gtest/gtest.h>

#include "tests/collision/motion_cases.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kRounding = 1e-12;

bool contains(const Bounds& box, const Vec3& motion)
{
    return ((motion - box.lower).array() >= -kRounding).all() &&
           ((box.upper - motion).array() >= -kRounding).all();
}

class MotionBoundsTest : public testing::Test {
protected:
    MotionBoundsTest() { bounds_.build(made_.triangles, made_.before, made_.now, made_.box()); }

    /// Random point of triangle t, and its displacement.
    std::pair<Vec3, Vec3> point_of(int t)
    {
        double u = random_.uniform(0, 1), v = random_.uniform(0, 1);
        if (u + v > 1.0)
            u = 1.0 - u, v = 1.0 - v;
        const Triangle& corner = made_.triangles[t];
        const auto at = [&](const std::vector<Vec3>& x) {
            return Vec3((1.0 - u - v) * x[corner[0]] + u * x[corner[1]] + v * x[corner[2]]);
        };
        return {at(made_.now), at(made_.now) - at(made_.before)};
    }

    Random random_{1};
    MotionCase made_ = motion_case(random_);
    MotionBounds bounds_;
};

TEST_F(MotionBoundsTest, BoundAllMotionWithinReach)
{
    const MotionView view = bounds_.view();
    int covered = 0;
    for (int pass = 0; pass < 10; ++pass)
        for (int t = 0; t < int(made_.triangles.size()); ++t) {
            const auto [point, motion] = point_of(t);
            const Vec3 beside = point + random_.uniform(0, MotionView::kReach) * random_.point().normalized();
            const Bounds* const around = view.around(beside);
            ASSERT_NE(around, nullptr) << "triangle " << t;
            EXPECT_TRUE(contains(*around, motion)) << "triangle " << t << " moves by " << motion.transpose();
            ++covered;
        }
    EXPECT_GT(covered, 10000);
}

TEST_F(MotionBoundsTest, IgnoreDistantMotion)
{
    // The sheet alone, far from its end: displacements vary with x.
    Soup sheet;
    add_sheet(sheet, 100, 0.02, 0.0);
    std::vector<Vec3> before;
    for (const Vec3& x : sheet.x)
        before.push_back(x - Vec3(0.1 * x.x(), 0.0, 0.0));
    bounds_.build(sheet.triangles, before, sheet.x, bounds(sheet.x));
    const Bounds* const around = bounds_.view().around(Vec3(0.5, 0.0, 1.0));
    ASSERT_NE(around, nullptr);
    constexpr double kMaxOffset =
        2.0 * MotionView::kReach + 0.02; // one cell beyond that of the point, plus an edge
    EXPECT_GT(around->lower.x(), 0.1 * (0.5 - kMaxOffset));
    EXPECT_LT(around->upper.x(), 0.1 * (0.5 + kMaxOffset));
    EXPECT_EQ(bounds_.view().around(Vec3(0.5, 1.0, 1.0)), nullptr) << "nothing is there";
}

} // namespace
} // namespace toile::test
