#include "collision/ccd/short_edges.h"

#include <gtest/gtest.h>

#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

namespace {

/// The ends of an overstretched edge keep as much of the difference of their motions as its length allows.
TEST(ShortEdges, KeepTheMaxAllowedFraction)
{
    test::Random random(71);
    ShortEdges edges({{0, 1}}, 2);
    int limited = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const std::vector<Vec3> base{random.point(), random.point()}, motion{random.point(), random.point()};
        const double length = (base[1] - base[0]).norm();
        edges.begin(base, 2.0 * length);
        std::vector<int> overstretched;
        edges.find_overstretched(std::vector<int>{0}, motion, overstretched);
        if (overstretched.empty())
            continue;
        ++limited;
        const double fraction = edges.fraction(0, motion);
        ASSERT_GT(fraction, 0.0);
        ASSERT_LT(fraction, 1.0);
        ASSERT_NEAR((base[1] - base[0] + fraction * (motion[1] - motion[0])).norm(), 1.02 * length, 1e-12);
    }
    EXPECT_GT(limited, 100);
}

TEST(ShortEdges, AreFoundOnceInOrderAndOnlyIfShort)
{
    ShortEdges edges({{0, 1}, {1, 2}, {0, 2}, {2, 3}}, 4);
    const std::vector<Vec3> base{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 9, 0)};
    edges.begin(base, 2.0);
    std::vector<Vec3> motion(4, Vec3::Zero());
    std::vector<int> overstretched;
    edges.find_overstretched(std::vector<int>{0, 1, 2, 3}, motion, overstretched);
    EXPECT_TRUE(overstretched.empty());
    motion[2] = Vec3(-0.1, 0.1, 0);
    motion[3] = Vec3(0, 1, 0); // of a long edge
    edges.find_overstretched(std::vector<int>{2, 1}, motion, overstretched);
    EXPECT_EQ(overstretched, (std::vector<int>{1, 2}));
}

} // namespace
} // namespace toile::test
