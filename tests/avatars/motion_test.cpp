#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "avatars/load_avatar.h"
#include "avatars/model/motion.h"
#include "tests/avatars/column.h"

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

/// A turn by 90 degrees: the smoothstep is 1.5 times as fast as its mean, the farthest vertex turns fastest.
TEST(BlendDuration, TurnsTheFarthestVertexAtTheSpeedAskedFor)
{
    AvatarSettings settings;
    settings.file = column_file();
    const std::unique_ptr<Avatar> column = load_avatar(settings);
    Motion motion;
    motion.clip = "bend";
    motion.start = 1.0;
    double radius = 0.0; // about the z axis through the tip
    for (const Vec3& p : posed(*column, {}))
        radius = std::max(radius, p.y() > 0.75 ? std::hypot(p.x(), p.y() - 0.5) : 0.0);
    const double speed = 0.8; // [m/s]
    const double expected = 1.5 * 0.5 * std::numbers::pi * radius / speed;
    EXPECT_NEAR(blend_duration(*column, motion, speed), expected, 1e-3 * expected);
    motion.start = 0.0;
    EXPECT_NEAR(blend_duration(*column, motion, speed), 0.0, 1e-12) << "the bind pose";
}

TEST(BlendDuration, TurnsTheMannequinNoFaster)
{
    const std::unique_ptr<Avatar> mannequin = load_avatar({});
    Motion motion;
    motion.clip = "walk";
    motion.pre_roll = {0.0, blend_duration(*mannequin, motion, 1.0), true};
    const double h = 1e-3; // [s]
    double fastest = 0.0;
    std::vector<Vec3> before;
    for (double t = 0.0; t < motion.pre_roll.ease; t += h) {
        const std::vector<Vec3> x =
            posed(*mannequin, pose_at(motion, mannequin->clip_index("walk"), kDuration, t));
        for (size_t v = 0; v < before.size(); ++v)
            fastest = std::max(fastest, (x[v] - before[v]).norm() / h);
        before = x;
    }
    EXPECT_NEAR(fastest, 1.0, 2e-3);
}

TEST(EndTime, IsWhenTheLastPoseBegins)
{
    const Motion motion = rolled_in();
    const double end = end_time(motion, kDuration);
    EXPECT_EQ(pose_at(motion, 0, kDuration, end + 1e-9).time, kDuration);
    EXPECT_LT(pose_at(motion, 0, kDuration, end - 1e-3).time, kDuration - 1e-3);
}

TEST(EndTime, MayLieInTheRamp)
{
    const Motion motion = rolled_in();
    const double duration = motion.start + 0.1, end = end_time(motion, duration);
    EXPECT_EQ(pose_at(motion, 0, duration, end + 1e-9).time, duration);
    EXPECT_LT(pose_at(motion, 0, duration, end - 1e-3).time, duration);
    EXPECT_EQ(end_time(motion, motion.start), motion.pre_roll.hold + motion.pre_roll.ease)
        << "it begins with its last pose";
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
