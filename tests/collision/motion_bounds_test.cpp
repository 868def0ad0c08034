#include "collision/motion_bounds.h"

#include <gtest/gtest.h>

#include "tests/collision/motion_cases.h"

namespace toile::test {
namespace {

constexpr double kRounding = 1e-12;

bool holds(const Bounds& box, const Vec3& motion)
{
    return ((motion - box.lower).array() >= -kRounding).all() &&
           ((box.upper - motion).array() >= -kRounding).all();
}

class MotionBoundsTest : public testing::Test {
protected:
    MotionBoundsTest() { bounds_.build(made_.triangles, made_.before, made_.now, made_.box()); }

    /// A point of triangle t, and how it has moved.
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

TEST_F(MotionBoundsTest, HoldTheMotionOfAllThatIsWithinReach)
{
    const MotionView view = bounds_.view();
    int held = 0;
    for (int round = 0; round < 10; ++round)
        for (int t = 0; t < int(made_.triangles.size()); ++t) {
            const auto [point, motion] = point_of(t);
            const Vec3 beside = point + random_.uniform(0, MotionView::kReach) * random_.point().normalized();
            const Bounds* const around = view.around(beside);
            ASSERT_NE(around, nullptr) << "triangle " << t;
            EXPECT_TRUE(holds(*around, motion)) << "triangle " << t << " moves by " << motion.transpose();
            ++held;
        }
    EXPECT_GT(held, 10000);
}

TEST_F(MotionBoundsTest, HoldNoMoreThanWhatIsNear)
{
    // The sheet alone, far from its end: motions differ by x.
    Soup sheet;
    add_sheet(sheet, 100, 0.02, 0.0);
    std::vector<Vec3> before;
    for (const Vec3& x : sheet.x)
        before.push_back(x - Vec3(0.1 * x.x(), 0.0, 0.0));
    bounds_.build(sheet.triangles, before, sheet.x, bounds(sheet.x));
    const Bounds* const around = bounds_.view().around(Vec3(0.5, 0.0, 1.0));
    ASSERT_NE(around, nullptr);
    constexpr double kFarthest = 2.0 * MotionView::kReach + 0.02; // a cell beside that of the point, an edge
    EXPECT_GT(around->lower.x(), 0.1 * (0.5 - kFarthest));
    EXPECT_LT(around->upper.x(), 0.1 * (0.5 + kFarthest));
    EXPECT_EQ(bounds_.view().around(Vec3(0.5, 1.0, 1.0)), nullptr) << "nothing is there";
}

} // namespace
} // namespace toile::test
