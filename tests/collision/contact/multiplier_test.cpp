#include <gtest/gtest.h>

#include <cmath>

#include "collision/contact/term.h"

namespace toile::test {

using namespace collision;

namespace {

constexpr double kKeep = 5e-4, kMinGap = 1e-4; // [m]

/// A point above a surface, pressed down by a spring of its own towards a place below it.
struct Pressed {
    double stiffness; ///< [N/m]
    double below;     ///< [m]
    ContactTerm term;

    Pressed(double pressing, double towards) : stiffness(pressing), below(towards)
    {
        term.spring = {800.0, 0.6 * kKeep, 0.7 * kKeep};
    }

    /// Gap in equilibrium [m], by bisection.
    double gap() const
    {
        double low = -below, high = kKeep + term.spring.shift;
        for (int k = 0; k < 100; ++k) {
            const double middle = 0.5 * (low + high);
            const double force = term.spring.force(kKeep - middle) - stiffness * (middle + below);
            (force > 0.0 ? low : high) = middle;
        }
        return low;
    }

    /// Number of updates until the gap is at least half of the smallest.
    int updates(bool is_near = true)
    {
        int count = 0;
        while (gap() < 0.5 * kMinGap && count < 1000) {
            term.multiplier.shortfall = kMinGap - gap();
            term.update_multiplier(is_near);
            ++count;
        }
        return count;
    }
};

TEST(ContactMultiplier, IsNotNeededByWhatTheSpringHolds) { EXPECT_EQ(Pressed(100.0, 1e-3).updates(), 0); }

TEST(ContactMultiplier, HoldsWhatPressesHarder)
{
    EXPECT_LE(Pressed(800.0, 0.01).updates(), 10);
    EXPECT_LE(Pressed(8e4, 0.001).updates(), 25) << "much stiffer, as cloth at its strain limit is";
}

TEST(ContactMultiplier, GrowsSlowlyFarFromTheMinimum)
{
    EXPECT_GT(Pressed(8e4, 0.001).updates(false), 3 * Pressed(8e4, 0.001).updates(true));
}

TEST(ContactMultiplier, VanishesWhenNothingPresses)
{
    Pressed pressed(800.0, 0.01);
    pressed.updates();
    EXPECT_GT(pressed.term.spring.shift, 0.0);
    pressed.term.multiplier.shortfall = -0.01;
    pressed.term.update_multiplier(true);
    EXPECT_EQ(pressed.term.spring.shift, 0.0);
}

} // namespace
} // namespace toile::test
