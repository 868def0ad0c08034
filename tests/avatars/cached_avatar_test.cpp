#include <cmath>
#include <limits>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "avatars/model/cached_avatar.h"
#include "avatars/model/moving_avatar.h"
#include "tests/support/refusal.h"

namespace toile::test {

using namespace avatars;
using testing::HasSubstr;

namespace {

/// A tetrahedron.
const std::vector<Vec3> kRest{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
const std::vector<Triangle> kFaces{Triangle(0, 2, 1), Triangle(0, 1, 3), Triangle(1, 2, 3),
                                   Triangle(0, 3, 2)};

/// It turns about Z by `angle` [rad] a sample, and moves by (1, 0, 0) a sample.
std::vector<Vec3> moved(int sample, double angle)
{
    const Mat3 R = Eigen::AngleAxisd(angle * sample, Vec3::UnitZ()).toRotationMatrix();
    std::vector<Vec3> x;
    for (const Vec3& rest : kRest)
        x.push_back(R * rest + Vec3(sample, 0.0, 0.0));
    return x;
}

GeometryCache cache_of(int samples, double rate, double angle = 0.0)
{
    GeometryCache cache;
    cache.triangles = kFaces;
    cache.vertex_count = int(kRest.size());
    for (int k = 0; k < samples; ++k)
        cache.times.push_back(k / rate);
    cache.positions = [angle](int sample) { return moved(sample, angle); };
    return cache;
}

std::vector<Vec3> posed(CachedAvatar& avatar, const PoseAt& at)
{
    std::vector<Vec3> x(size_t(avatar.vertex_count()));
    avatar.pose(at, identity_affine(), x);
    return x;
}

PoseAt at_time(double time) { return {.clip = 0, .time = time}; }

TEST(CachedAvatar, IsLinearBetweenSamplesAndStaysAtTheEnds)
{
    CachedAvatar avatar("body.abc", cache_of(5, 8.0));
    ASSERT_EQ(avatar.clips().size(), 1u);
    EXPECT_EQ(avatar.clips()[0].name, "cache");
    EXPECT_EQ(avatar.clips()[0].duration, 0.5);
    EXPECT_EQ(posed(avatar, at_time(0.25)), moved(2, 0.0));
    EXPECT_EQ(posed(avatar, at_time(0.3125))[1], Vec3(1.0 + 2.5, 0.0, 0.0));
    EXPECT_EQ(posed(avatar, at_time(-1.0)), moved(0, 0.0));
    EXPECT_EQ(posed(avatar, at_time(9.0)), moved(4, 0.0));
    EXPECT_EQ(posed(avatar, {}), moved(0, 0.0)) << "the bind pose";
}

TEST(CachedAvatar, GivesItsSamplesAtTheTimesOfFrames)
{
    for (const double fps : {24.0, 24000.0 / 1001.0, 25.0, 29.97, 1000.0 / 7.0}) {
        CachedAvatar avatar("body.abc", cache_of(2000, fps, 0.1));
        for (const int k : {1, 2, 3, 7, 100, 1111, 1999})
            EXPECT_EQ(posed(avatar, at_time(k / fps)), moved(k, 0.1)) << k << " at " << fps;
    }
}

TEST(CachedAvatar, HasSamplesAtAnyTimes)
{
    GeometryCache cache = cache_of(4, 1.0);
    cache.times = {10.0, 10.1, 10.5, 12.5};
    CachedAvatar avatar("body.abc", std::move(cache));
    EXPECT_EQ(avatar.clips()[0].duration, 2.5);
    EXPECT_EQ(posed(avatar, at_time(0.0)), moved(0, 0.0));
    EXPECT_EQ(posed(avatar, at_time(0.5)), moved(2, 0.0));
    EXPECT_NEAR(posed(avatar, at_time(0.2))[0].x(), 1.25, 1e-12);
    EXPECT_NEAR(posed(avatar, at_time(1.5))[0].x(), 2.5, 1e-12);
    EXPECT_EQ(posed(avatar, at_time(2.5)), moved(3, 0.0));
    EXPECT_EQ(posed(avatar, at_time(7.0)), moved(3, 0.0));
}

TEST(CachedAvatar, ReadsEverySampleOnceAndKeepsFew)
{
    auto reads = std::make_shared<std::vector<int>>();
    GeometryCache cache = cache_of(1000, 10.0);
    cache.positions = [reads](int sample) {
        reads->push_back(sample);
        return moved(sample, 0.0);
    };
    CachedAvatar avatar("body.abc", std::move(cache));
    for (int step = 0; step < 3996; ++step) {
        posed(avatar, at_time(step / 40.0));
        posed(avatar, at_time(step / 40.0 + 0.25)); // as insets look ahead
    }
    EXPECT_EQ(reads->size(), 1000u);
    reads->clear();
    posed(avatar, at_time(0.0));
    EXPECT_EQ(*reads, std::vector<int>{0}) << "those of long ago are not kept";
}

TEST(CachedAvatar, BlendsFromItsFirstSample)
{
    CachedAvatar avatar("body.abc", cache_of(5, 8.0));
    PoseAt at = at_time(0.5);
    at.bind_weight = 0.75;
    EXPECT_EQ(posed(avatar, at)[0], Vec3(1.0, 0.0, 0.0));
}

TEST(CachedAvatar, TurnsItsBonesWithTheSurface)
{
    constexpr double kAngle = 0.3;
    CachedAvatar avatar("body.abc", cache_of(3, 8.0, kAngle));
    std::vector<Affine> first(4), last(4);
    avatar.pose_bones(at_time(0.0), identity_affine(), first);
    avatar.pose_bones(at_time(0.25), identity_affine(), last);
    const Mat3 R = Eigen::AngleAxisd(2.0 * kAngle, Vec3::UnitZ()).toRotationMatrix();
    for (size_t v = 0; v < 4; ++v) {
        EXPECT_LT((first[v].leftCols<3>() - Mat3::Identity()).norm(), 1e-14);
        EXPECT_LT((last[v].leftCols<3>() - R).norm(), 1e-14);
    }
}

TEST(CachedAvatar, KeepsItsBonesParallelWhereNothingAsksForMore)
{
    GeometryCache cache = cache_of(3, 8.0, 0.3);
    cache.turns_bones = false;
    CachedAvatar avatar("body.abc", std::move(cache));
    std::vector<Affine> bones(4);
    avatar.pose_bones(at_time(0.25), identity_affine(), bones);
    for (const Affine& bone : bones)
        EXPECT_EQ(bone.leftCols<3>(), Mat3::Identity());
    EXPECT_EQ(posed(avatar, at_time(0.25)), moved(2, 0.3));
}

TEST(CachedAvatar, MovesAtMostAsFarAsItsBoundAndNotMuchLess)
{
    Motion motion;
    motion.clip = CachedAvatar::kClip;
    MovingAvatar body(std::make_unique<CachedAvatar>("body.abc", cache_of(5, 8.0, 0.2)), motion, {});
    const double bound = body.max_motion_to(0.25);
    double largest = 0.0;
    for (size_t v = 0; v < 4; ++v)
        largest = std::max(largest, (moved(2, 0.2)[v] - moved(0, 0.2)[v]).norm());
    EXPECT_NEAR(bound, largest, 1e-14);
    body.advance_to(0.25);
    EXPECT_EQ(body.max_motion_to(0.25), 0.0);
}

TEST(CachedAvatar, IsPlacedInMetresWithYUp)
{
    GeometryCache cache = cache_of(2, 1.0);
    cache.metres_from_file.leftCols<3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    cache.metres_from_file *= 0.01;
    CachedAvatar avatar("body.abc", std::move(cache));
    EXPECT_LT((posed(avatar, {})[3] - Vec3(0.0, 0.01, 0.0)).norm(), 1e-17);
    EXPECT_LT((posed(avatar, {})[2] - Vec3(0.0, 0.0, -0.01)).norm(), 1e-17);
}

TEST(CachedAvatar, OfOneSampleHasNoClip)
{
    CachedAvatar avatar("body.abc", cache_of(1, 1.0));
    EXPECT_TRUE(avatar.is_static());
    EXPECT_EQ(posed(avatar, {}), kRest);
}

TEST(CachedAvatar, NamesTheVertexThatIsNoNumber)
{
    GeometryCache cache = cache_of(5, 8.0);
    cache.positions = [](int sample) {
        std::vector<Vec3> x = moved(sample, 0.0);
        if (sample == 3)
            x[2].y() = std::numeric_limits<double>::quiet_NaN();
        return x;
    };
    CachedAvatar avatar("body.abc", std::move(cache));
    EXPECT_EQ(refusal([&] { posed(avatar, at_time(0.25)); }), "");
    EXPECT_THAT(refusal([&] { posed(avatar, at_time(0.3)); }),
                HasSubstr("body.abc: vertex 2 of sample 3 is at (3, nan, 0)"));
}

TEST(CachedAvatar, RefusesSamplesOfAnotherMesh)
{
    GeometryCache cache = cache_of(5, 8.0);
    cache.positions = [](int sample) { return std::vector<Vec3>(sample == 1 ? 5 : 4, Vec3::Zero()); };
    CachedAvatar avatar("body.abc", std::move(cache));
    EXPECT_THAT(refusal([&] { posed(avatar, at_time(0.1)); }),
                HasSubstr("body.abc: sample 1 has 5 vertices and the mesh 4"));
}

} // namespace

} // namespace toile::test
