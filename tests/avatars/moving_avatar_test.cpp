#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "avatars/load_avatar.h"
#include "avatars/moving_avatar.h"
#include "core/backend/error.h"
#include "core/backend/stages.h"
#include "tests/avatars/column.h"

namespace toile {

namespace {

MovingAvatar column(const Motion& motion, const Placement& placement = {})
{
    AvatarSettings settings;
    settings.file = column_file();
    return {load_avatar(settings), motion, placement};
}

Motion play(const std::string& clip)
{
    Motion motion;
    motion.clip = clip;
    return motion;
}

std::string refusal(const Motion& motion, const Placement& placement = {})
{
    try {
        column(motion, placement);
        return "";
    } catch (const InvalidInput& error) {
        return error.what();
    }
}

} // namespace

TEST(MovingAvatar, HandsTheEndOfAStepToTheNext)
{
    MovingAvatar avatar = column(play("bend"));
    EXPECT_EQ(avatar.mesh().x_t0, avatar.mesh().x_t1);
    avatar.advance_to(0.25);
    EXPECT_TRUE(avatar.moved());
    const std::vector<Vec3> end = avatar.mesh().x_t1;
    avatar.advance_to(0.5);
    EXPECT_EQ(avatar.mesh().x_t0, end);
    EXPECT_NE(avatar.mesh().x_t1, end);
}

TEST(MovingAvatar, WithoutClipIsNeverSkinnedAgain)
{
    MovingAvatar avatar = column({});
    EXPECT_TRUE(avatar.is_static());
    Stages stages;
    const Stages::Activate recording(stages);
    for (int step = 1; step <= 10; ++step) {
        avatar.advance_to(0.1 * step);
        EXPECT_FALSE(avatar.moved());
    }
    EXPECT_EQ(stages.calls("avatars/skin"), 0);
}

TEST(MovingAvatar, IsSkinnedOncePerStepThatMovesIt)
{
    Motion motion = play("bend");
    motion.pre_roll.hold = 0.45;
    MovingAvatar avatar = column(motion);
    EXPECT_FALSE(avatar.is_static());
    Stages stages;
    const Stages::Activate recording(stages);
    for (int step = 1; step <= 20; ++step)
        avatar.advance_to(0.1 * step);
    // Steps 5 to 15 move it: held until 0.45 s, at the clip's end from 1.45 s on.
    EXPECT_EQ(stages.calls("avatars/skin"), 11);
    EXPECT_FALSE(avatar.moved());
    EXPECT_EQ(avatar.mesh().x_t0, avatar.mesh().x_t1);
}

TEST(MovingAvatar, StandsWhereItIsPlaced)
{
    Placement placement;
    placement.translate = {1.0, 2.0, 3.0};
    placement.rotate_deg = {90.0, 90.0, 0.0};
    placement.scale = 2.0;
    const std::vector<Vec3> rest = column({}).mesh().x_t1;
    const std::vector<Vec3> x = column({}, placement).mesh().x_t1;
    for (size_t v = 0; v < x.size(); ++v) {
        const Vec3 about_x(rest[v].x(), -rest[v].z(), rest[v].y());
        const Vec3 about_y(about_x.z(), about_x.y(), -about_x.x());
        EXPECT_LT((x[v] - (2.0 * about_y + placement.translate)).norm(), 1e-14);
    }
}

TEST(MovingAvatar, WalksOnWhereTheRootAccumulates)
{
    Motion motion = play("slide");
    motion.loop = true;
    MovingAvatar jumping = column(motion);
    motion.accumulate_root = true;
    Placement placement;
    placement.rotate_deg.y() = 90.0; // z to x
    MovingAvatar walking = column(motion, placement);
    const double x0 = walking.mesh().x_t1[0].x(), z0 = jumping.mesh().x_t1[0].z();
    jumping.advance_to(5.0);
    walking.advance_to(5.0);
    EXPECT_NEAR(jumping.mesh().x_t1[0].z() - z0, 0.5, 1e-9);
    EXPECT_NEAR(walking.mesh().x_t1[0].x() - x0, 2.5, 1e-9);
}

TEST(MovingAvatar, GivesTheSameBitsForEveryThreadCount)
{
    const auto walked = [](int threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        MovingAvatar avatar(make_mannequin(), play("walk"), {});
        avatar.advance_to(0.731);
        return avatar.mesh().x_t1;
    };
    EXPECT_EQ(walked(1), walked(4));
}

TEST(MovingAvatar, RefusesMotionsItCannotPlay)
{
    EXPECT_NE(refusal(play("bendd")).find("did you mean 'bend'"), std::string::npos);
    Motion motion = play("bend");
    motion.speed = -1.0;
    EXPECT_NE(refusal(motion).find("speed = -1"), std::string::npos);
    motion.speed = 1.0;
    motion.start = 1.5;
    EXPECT_NE(refusal(motion).find("after the end of clip 'bend'"), std::string::npos);
    Placement placement;
    placement.scale = 0.0;
    EXPECT_NE(refusal({}, placement).find("scale = 0"), std::string::npos);
}

} // namespace toile
