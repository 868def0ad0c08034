#include <gtest/gtest.h>

#include <cmath>

#include "avatars/model/motion.h"

namespace toile::test {

using namespace avatars;

namespace {

/// Two seconds in the bind pose, one of blend, one of ramp, at 1.5 times speed.
Motion rolled_in()
{
    Motion motion;
    motion.clip = "any";
    motion.speed = 1.5;
    motion.start = 0.25;
    motion.pre_roll = {2.0, 1.0, true};
    return motion;
}

constexpr double kDuration = 10.0; // [s]

} // namespace

TEST(PreRoll, HoldsThenBlendsThenRuns)
{
    const Motion motion = rolled_in();
    EXPECT_EQ(pose_at(motion, 0, kDuration, 0.0).bind_weight, 1.0);
    EXPECT_EQ(pose_at(motion, 0, kDuration, 2.0).bind_weight, 1.0);
    EXPECT_NEAR(pose_at(motion, 0, kDuration, 2.5).bind_weight, 0.5, 1e-15);
    EXPECT_EQ(pose_at(motion, 0, kDuration, 3.0).bind_weight, 0.0);
    EXPECT_EQ(pose_at(motion, 0, kDuration, 3.0).time, 0.25);
    // The ramp gains half of its length, then full speed.
    EXPECT_NEAR(pose_at(motion, 0, kDuration, 4.0).time, 0.25 + 1.5 * 0.5, 1e-15);
    EXPECT_NEAR(pose_at(motion, 0, kDuration, 6.0).time, 0.25 + 1.5 * 2.5, 1e-15);
}

TEST(PreRoll, IsContinuousInPositionAndVelocity)
{
    const Motion motion = rolled_in();
    const double h = 1e-4; // [s]
    const auto time = [&](double t) { return pose_at(motion, 0, kDuration, t).time; };
    const auto fraction = [&](double t) { return pose_at(motion, 0, kDuration, t).bind_weight; };
    for (double t = 0.01; t < 5.0; t += 0.5 * h) {
        // A jump in value would exceed the max rate; a jump in rate the max acceleration, 6 per s^2.
        ASSERT_LE(std::abs(time(t + h) - time(t)), 1.51 * h) << t;
        ASSERT_LE(std::abs(fraction(t + h) - fraction(t)), 1.51 * h) << t;
        ASSERT_LE(std::abs(time(t + h) - 2.0 * time(t) + time(t - h)), 6.1 * h * h) << t;
        ASSERT_LE(std::abs(fraction(t + h) - 2.0 * fraction(t) + fraction(t - h)), 6.1 * h * h) << t;
    }
    EXPECT_NEAR((time(4.5 + h) - time(4.5)) / h, 1.5, 1e-9);
}

TEST(PreRoll, WithoutBindPoseHoldsTheClipsFirstPose)
{
    Motion motion = rolled_in();
    motion.pre_roll.from_bind = false;
    EXPECT_EQ(pose_at(motion, 0, kDuration, 1.0).bind_weight, 0.0);
    EXPECT_EQ(pose_at(motion, 0, kDuration, 2.0).time, 0.25);
    EXPECT_NEAR(pose_at(motion, 0, kDuration, 3.0).time, 0.25 + 0.75, 1e-15);
}

TEST(PreRoll, OfZeroLengthStartsAtOnce)
{
    Motion motion;
    motion.clip = "any";
    motion.pre_roll = {0.0, 0.0, true};
    EXPECT_EQ(pose_at(motion, 0, kDuration, 0.0), (PoseAt{0, 0.0, 0.0, 0}));
    EXPECT_EQ(pose_at(motion, 0, kDuration, 1.0), (PoseAt{0, 1.0, 0.0, 0}));
}

TEST(Motion, HoldsTheLastPoseWithoutLoop)
{
    Motion motion;
    motion.clip = "any";
    EXPECT_EQ(pose_at(motion, 0, 2.0, 1.9).time, 1.9);
    EXPECT_EQ(pose_at(motion, 0, 2.0, 2.1).time, 2.0);
    EXPECT_EQ(pose_at(motion, 0, 2.0, 1e6).time, 2.0);
}

TEST(Motion, LoopsAndCountsCyclesOnlyWhereTheRootAccumulates)
{
    Motion motion;
    motion.clip = "any";
    motion.loop = true;
    EXPECT_NEAR(pose_at(motion, 0, 2.0, 5.5).time, 1.5, 1e-15);
    EXPECT_EQ(pose_at(motion, 0, 2.0, 5.5).cycles, 0);
    motion.accumulate_root = true;
    EXPECT_EQ(pose_at(motion, 0, 2.0, 5.5).cycles, 2);
}

} // namespace toile::test
