#include <gtest/gtest.h>

#include "core/pd/step/step_passes.h"

namespace toile::test {
namespace {

OuterLoop::Outcome ended_after(int iterations, bool converged)
{
    OuterLoop::Outcome outcome;
    outcome.iterations = iterations;
    outcome.converged = converged;
    return outcome;
}

TEST(StepPasses, AreOneMinimisationWithoutContact)
{
    StepPasses passes(30, 3);
    EXPECT_EQ(passes.next(false), 30);
    EXPECT_FALSE(passes.goes_on(ended_after(30, false), false));
}

TEST(StepPasses, AreTruncatedTwiceBeforeAFullMinimisation)
{
    StepPasses passes(30, 3);
    for (int pass = 0; pass < StepPasses::kShortPasses; ++pass) {
        EXPECT_EQ(passes.is_first(), pass == 0);
        EXPECT_EQ(passes.next(true), StepPasses::kShortIterations);
        const OuterLoop::Outcome cut_short = ended_after(StepPasses::kShortIterations, false);
        EXPECT_FALSE(passes.is_converged(cut_short));
        EXPECT_TRUE(passes.goes_on(cut_short, false));
    }
    EXPECT_EQ(passes.next(true), 30);
    EXPECT_TRUE(passes.goes_on(ended_after(20, true), true));
    EXPECT_EQ(passes.next(true), 30);
    EXPECT_FALSE(passes.goes_on(ended_after(30, false), false)) << "not cut short, and nothing has changed";
}

TEST(StepPasses, EndWhenNewPairsChangeNothing)
{
    StepPasses passes(30, 3);
    EXPECT_EQ(passes.next(true), StepPasses::kShortIterations);
    EXPECT_TRUE(passes.is_converged(ended_after(2, true)));
    EXPECT_TRUE(passes.is_converged(ended_after(2, false))) << "no direction lowers the energy";
    EXPECT_FALSE(passes.goes_on(ended_after(2, true), false));
}

TEST(StepPasses, EndAtMaxPasses)
{
    StepPasses passes(1000, 1);
    int count = 1;
    for (passes.next(true); passes.goes_on(ended_after(1, true), true); passes.next(true))
        ++count;
    EXPECT_EQ(count, StepPasses::kShortPasses + 1);
}

} // namespace
} // namespace toile::test
