#include <gtest/gtest.h>

#include "core/pd/step_rounds.h"

namespace toile {
namespace {

OuterLoop::Outcome ended_after(int iterations, bool converged)
{
    OuterLoop::Outcome outcome;
    outcome.iterations = iterations;
    outcome.converged = converged;
    return outcome;
}

TEST(StepRounds, AreOneMinimisationWhereNothingTouches)
{
    StepRounds rounds(30, 3);
    EXPECT_EQ(rounds.next(false), 30);
    EXPECT_FALSE(rounds.goes_on(ended_after(30, false), false));
}

TEST(StepRounds, LookTwiceBeforeTheyMinimise)
{
    StepRounds rounds(30, 3);
    for (int look = 0; look < StepRounds::kLooks; ++look) {
        EXPECT_EQ(rounds.is_first(), look == 0);
        EXPECT_EQ(rounds.next(true), StepRounds::kIterationsOfLook);
        const OuterLoop::Outcome cut_short = ended_after(StepRounds::kIterationsOfLook, false);
        EXPECT_FALSE(rounds.is_settled(cut_short));
        EXPECT_TRUE(rounds.goes_on(cut_short, false));
    }
    EXPECT_EQ(rounds.next(true), 30);
    EXPECT_TRUE(rounds.goes_on(ended_after(20, true), true));
    EXPECT_EQ(rounds.next(true), 30);
    EXPECT_FALSE(rounds.goes_on(ended_after(30, false), false)) << "no look, and nothing has changed";
}

TEST(StepRounds, EndWhereWhatIsFoundChangesNothing)
{
    StepRounds rounds(30, 3);
    EXPECT_EQ(rounds.next(true), StepRounds::kIterationsOfLook);
    EXPECT_TRUE(rounds.is_settled(ended_after(2, true)));
    EXPECT_TRUE(rounds.is_settled(ended_after(2, false))) << "no direction lowers the energy";
    EXPECT_FALSE(rounds.goes_on(ended_after(2, true), false));
}

TEST(StepRounds, EndAfterAsManyAsAllowed)
{
    StepRounds rounds(1000, 1);
    int count = 1;
    for (rounds.next(true); rounds.goes_on(ended_after(1, true), true); rounds.next(true))
        ++count;
    EXPECT_EQ(count, StepRounds::kLooks + 1);
}

} // namespace
} // namespace toile
