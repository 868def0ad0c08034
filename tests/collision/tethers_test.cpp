#include "collision/cloth/tethers.h"

#include <gtest/gtest.h>

#include "tests/collision/pair_cases.h"

namespace toile {
namespace {

/// An edge of which one end keeps less of its way than the other: the other keeps as much as the edge lets
/// it.
TEST(Tethers, LetTheLastGoAsFarAsTheEdgeAllows)
{
    test::Random random(71);
    constexpr double kSlack = 0.02;
    Tethers tethers({{0, 1}}, 2);
    int limited = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const std::vector<Vec3> base{random.point(), random.point()}, ways{random.point(), random.point()};
        const Vec3 common = random.point();
        const double least = random.scale(0.01, 1.0);
        tethers.begin(base, ways, kSlack);
        const auto length = [&](double share) {
            const Vec3 first = base[0] + common + least * (ways[0] - common);
            return (base[1] + common + share * (ways[1] - common) - first).norm();
        };
        const double allowed =
            std::max((base[0] - base[1]).norm(), (base[0] + ways[0] - base[1] - ways[1]).norm()) + kSlack;
        const double share = tethers.share_behind(0, 1, common, least);
        ASSERT_GE(share, least);
        ASSERT_LE(share, 1.0);
        ASSERT_LE(length(share), allowed + 1e-12);
        if (share < 1.0) {
            ASSERT_NEAR(length(share), allowed, 1e-12);
            ++limited;
        }
    }
    EXPECT_GT(limited, 100);
}

TEST(Tethers, FindTornEdgesAroundVerticesOnceAndInOrder)
{
    Tethers tethers({{0, 1}, {1, 2}, {0, 2}, {2, 3}}, 4);
    const std::vector<Vec3> base{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 2, 0)};
    std::vector<Vec3> motion(4, Vec3::Zero());
    tethers.begin(base, motion, 0.02);
    std::vector<int> torn;
    tethers.find_torn(std::vector<int>{0, 1, 2, 3}, motion, torn);
    EXPECT_TRUE(torn.empty());
    std::vector<Vec3> apart = motion;
    apart[2] = Vec3(-0.1, 0.1, 0);
    tethers.find_torn(std::vector<int>{2, 1}, apart, torn);
    EXPECT_EQ(torn, (std::vector<int>{1, 2}));
}

} // namespace
} // namespace toile
