#include "collision/ccd/edge_stretch_limiter.h"

#include <gtest/gtest.h>

#include "tests/collision/pair_cases.h"

namespace toile::test {

using namespace collision;

namespace {

/// Edge whose one end keeps a smaller fraction of its displacement: the other end keeps as much as the
/// stretch limit allows.
TEST(EdgeStretchLimiter, GivesTheTrailingVertexTheMaxAllowedFraction)
{
    test::Random random(71);
    constexpr double kSlack = 0.02;
    EdgeStretchLimiter stretch_limiter({{0, 1}}, 2);
    int limited = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        const std::vector<Vec3> base{random.point(), random.point()},
            displacements{random.point(), random.point()};
        const Vec3 common = random.point();
        const double min_fraction = random.scale(0.01, 1.0);
        stretch_limiter.begin(base, displacements, kSlack);
        const auto length = [&](double fraction) {
            const Vec3 first = base[0] + common + min_fraction * (displacements[0] - common);
            return (base[1] + common + fraction * (displacements[1] - common) - first).norm();
        };
        const double allowed = std::max((base[0] - base[1]).norm(),
                                        (base[0] + displacements[0] - base[1] - displacements[1]).norm()) +
                               kSlack;
        const double fraction = stretch_limiter.trailing_fraction(0, 1, common, min_fraction);
        ASSERT_GE(fraction, min_fraction);
        ASSERT_LE(fraction, 1.0);
        ASSERT_LE(length(fraction), allowed + 1e-12);
        if (fraction < 1.0) {
            ASSERT_NEAR(length(fraction), allowed, 1e-12);
            ++limited;
        }
    }
    EXPECT_GT(limited, 100);
}

TEST(EdgeStretchLimiter, FindsOverstretchedEdgesOnceAndInOrder)
{
    EdgeStretchLimiter stretch_limiter({{0, 1}, {1, 2}, {0, 2}, {2, 3}}, 4);
    const std::vector<Vec3> base{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 2, 0)};
    std::vector<Vec3> motion(4, Vec3::Zero());
    stretch_limiter.begin(base, motion, 0.02);
    std::vector<int> overstretched;
    stretch_limiter.find_overstretched(std::vector<int>{0, 1, 2, 3}, motion, overstretched);
    EXPECT_TRUE(overstretched.empty());
    std::vector<Vec3> apart = motion;
    apart[2] = Vec3(-0.1, 0.1, 0);
    stretch_limiter.find_overstretched(std::vector<int>{2, 1}, apart, overstretched);
    EXPECT_EQ(overstretched, (std::vector<int>{1, 2}));
}

} // namespace
} // namespace toile::test
