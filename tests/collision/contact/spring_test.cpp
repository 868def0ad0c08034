#include <gtest/gtest.h>

#include "collision/contact/spring.h"

namespace toile::test {

using namespace collision;

namespace {

/// Linear, with a ramp, hardening, and shifted: the second spring begins inside the ramp, or before contact.
constexpr ContactSpring kSprings[] = {{800.0, 0.0},
                                      {800.0, 3e-4},
                                      {2e5, 1e-3},
                                      {800.0, 3e-4, 5e-4},
                                      {800.0, 3e-4, 5e-4, 2.6e-4},
                                      {800.0, 3e-4, 5e-4, 9e-4}};

TEST(ContactSpring, HasTheSlopesOfItsEnergy)
{
    for (const ContactSpring& spring : kSprings)
        for (const double depth : {-1e-3, 5e-5, 2e-4, 7e-4, 1.5e-3, 1e-2}) {
            const double h = 1e-8;
            const double slope = (spring.energy(depth + h) - spring.energy(depth - h)) / (2.0 * h);
            const double bend = (spring.force(depth + h) - spring.force(depth - h)) / (2.0 * h);
            EXPECT_NEAR(spring.force(depth), slope, 1e-5 * spring.force(depth)) << depth;
            EXPECT_NEAR(spring.stiffness_at(depth), bend, 1e-5 * spring.stiffness) << depth;
        }
}

TEST(ContactSpring, IsSmoothWhereItBeginsAndWhereItsRampEnds)
{
    for (const ContactSpring& spring : kSprings)
        for (const double depth : {0.0, spring.ramp, spring.hard - spring.shift}) {
            const double h = 1e-9, w = 9.0 * spring.stiffness; // of both springs
            const double before = spring.force(depth - h), after = spring.force(depth + h);
            EXPECT_NEAR(spring.energy(depth + h) - spring.energy(depth - h), h * (before + after),
                        3.0 * w * h * h);
            EXPECT_NEAR(after, before, 2.1 * w * h);
            if (spring.ramp > 0.0) {
                EXPECT_NEAR(spring.stiffness_at(depth + h), spring.stiffness_at(depth - h), 1e-4 * w);
            }
        }
}

TEST(ContactSpring, FindsTheDepthOfAForce)
{
    for (const ContactSpring& spring : kSprings) {
        EXPECT_EQ(spring.depth_of(0.0), 0.0);
        for (const double depth : {1e-6, 2e-4, 3e-3})
            EXPECT_NEAR(spring.depth_of(spring.force(depth)), depth, 1e-12);
    }
}

TEST(ContactSpring, RestsWhereItsForceBalances)
{
    for (const ContactSpring& spring : kSprings) {
        EXPECT_EQ(spring.depth_at_rest(-1e-3, 1.0), 0.0);
        for (const double mobility : {0.0, 1e-4, 0.3, 50.0})
            for (const double reach : {1e-6, 4e-4, 2e-2}) {
                const double depth = spring.depth_at_rest(reach, mobility);
                if (mobility * spring.force(0.0) > reach) {
                    EXPECT_EQ(depth, 0.0);
                    continue;
                }
                EXPECT_NEAR(depth + mobility * spring.force(depth), reach, 1e-9 * reach);
            }
    }
}

} // namespace
} // namespace toile::test
