#include <gtest/gtest.h>

#include <tbb/global_control.h>

#include "avatars/load_avatar.h"
#include "avatars/model/moving_avatar.h"
#include "core/base/error.h"
#include "core/base/stages.h"
#include "tests/avatars/column.h"

namespace toile::test {

using namespace avatars;

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

std::vector<Vec3> skinned(const MovingAvatar& avatar, View<const Affine> bones)
{
    std::vector<Vec3> x(size_t(avatar.avatar().vertex_count()));
    avatar.avatar().skin_vertices(bones, x);
    return x;
}
std::vector<Vec3> x_t0(const MovingAvatar& avatar) { return skinned(avatar, avatar.bones_t0()); }
std::vector<Vec3> x_t1(const MovingAvatar& avatar) { return skinned(avatar, avatar.bones_t1()); }

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

TEST(MovingAvatar, BoundsItsMotionAheadWithoutAStep)
{
    MovingAvatar avatar = column(play("bend"));
    avatar.advance_to(0.1);
    const std::vector<Vec3> before = x_t1(avatar);
    const double bound = avatar.max_motion_to(0.3);
    EXPECT_EQ(x_t1(avatar), before);
    avatar.advance_to(0.3);
    const std::vector<Vec3> after = x_t1(avatar);
    double largest = 0.0;
    for (size_t v = 0; v < after.size(); ++v)
        largest = std::max(largest, (after[v] - before[v]).norm());
    EXPECT_GT(largest, 0.0);
    EXPECT_GE(bound, largest * (1.0 - 1e-12));
    EXPECT_LE(bound, 1.5 * largest);
    EXPECT_EQ(avatar.max_motion_to(0.3), 0.0) << "the pose that it has";
}

TEST(MovingAvatar, StartsAStepWhereTheLastEnded)
{
    MovingAvatar avatar = column(play("bend"));
    EXPECT_EQ(x_t0(avatar), x_t1(avatar));
    avatar.advance_to(0.25);
    EXPECT_TRUE(avatar.moved());
    const std::vector<Vec3> end = x_t1(avatar);
    avatar.advance_to(0.5);
    EXPECT_EQ(x_t0(avatar), end);
    EXPECT_NE(x_t1(avatar), end);
}

TEST(MovingAvatar, WithoutClipNeverMoves)
{
    MovingAvatar avatar = column({});
    EXPECT_TRUE(avatar.is_static());
    for (int step = 1; step <= 10; ++step) {
        avatar.advance_to(0.1 * step);
        EXPECT_FALSE(avatar.moved());
    }
}

TEST(MovingAvatar, MovesOnlyInStepsThatChangeItsPose)
{
    Motion motion = play("bend");
    motion.pre_roll.hold = 0.45;
    MovingAvatar avatar = column(motion);
    EXPECT_FALSE(avatar.is_static());
    // The pose is constant until 0.45 s and from 1.45 s, the clip's end, on.
    for (int step = 1; step <= 20; ++step) {
        avatar.advance_to(0.1 * step);
        EXPECT_EQ(avatar.moved(), step >= 5 && step <= 15) << step;
    }
    EXPECT_EQ(x_t0(avatar), x_t1(avatar));
}

TEST(MovingAvatar, MovesAsAWhole)
{
    MovingAvatar standing = column(play("bend")), transformed = column(play("bend"));
    standing.advance_to(0.25);
    const std::vector<Vec3> start = x_t1(standing);
    Affine target = identity_affine();
    target.leftCols<3>() = Eigen::AngleAxisd(0.5, Vec3::UnitY()).toRotationMatrix();
    target.col(3) = Vec3(0.1, 0.2, 0.3);
    transformed.advance_to(0.25, target);
    const std::vector<Vec3> end = x_t1(transformed);
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((end[v] - apply(target, start[v])).norm(), 1e-14);
    transformed.advance_to(0.25, target);
    EXPECT_FALSE(transformed.moved());
    transformed.advance_to(0.25);
    EXPECT_TRUE(transformed.moved());
    EXPECT_EQ(x_t0(transformed), end);
    EXPECT_EQ(x_t1(transformed), start);
}

TEST(MovingAvatar, IsSkinnedOnlyOnDemand)
{
    MovingAvatar avatar = column(play("bend"));
    Stages stages;
    const Stages::Activate recording(stages);
    avatar.advance_to(0.25);
    EXPECT_EQ(stages.calls("avatars/skin"), 0);
    (void)x_t1(avatar);
    EXPECT_EQ(stages.calls("avatars/skin"), 1);
}

TEST(MovingAvatar, AppliesItsPlacement)
{
    Placement placement;
    placement.translate = {1.0, 2.0, 3.0};
    placement.rotate_deg = {90.0, 90.0, 0.0};
    placement.scale = 2.0;
    const std::vector<Vec3> rest = x_t1(column({}));
    const std::vector<Vec3> x = x_t1(column({}, placement));
    for (size_t v = 0; v < x.size(); ++v) {
        const Vec3 about_x(rest[v].x(), -rest[v].z(), rest[v].y());
        const Vec3 about_y(about_x.z(), about_x.y(), -about_x.x());
        EXPECT_LT((x[v] - (2.0 * about_y + placement.translate)).norm(), 1e-14);
    }
}

TEST(MovingAvatar, ContinuesFromItsAccumulatedRoot)
{
    Motion motion = play("slide");
    motion.loop = true;
    MovingAvatar jumping = column(motion);
    motion.accumulate_root = true;
    Placement placement;
    placement.rotate_deg.y() = 90.0; // z to x
    MovingAvatar walking = column(motion, placement);
    const double x0 = x_t1(walking)[0].x(), z0 = x_t1(jumping)[0].z();
    jumping.advance_to(5.0);
    walking.advance_to(5.0);
    EXPECT_NEAR(x_t1(jumping)[0].z() - z0, 0.5, 1e-9);
    EXPECT_NEAR(x_t1(walking)[0].x() - x0, 2.5, 1e-9);
}

TEST(MovingAvatar, GivesTheSameBitsForEveryThreadCount)
{
    const auto walked = [](int threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        MovingAvatar avatar(make_mannequin(), play("walk"), {});
        avatar.advance_to(0.731);
        return x_t1(avatar);
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

} // namespace toile::test
