#include "avatars/model/clip.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace avatars;

namespace {

Skeleton one_joint()
{
    Skeleton skeleton;
    skeleton.add({"joint", -1, {}});
    return skeleton;
}

JointTransform sampled(const JointTrack& track, double time)
{
    Clip clip{"clip", 10.0, {track}};
    std::vector<JointTransform> out(1);
    sample(clip, one_joint(), time, out);
    return out[0];
}

Eigen::Quaterniond about_z(double angle)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
}

} // namespace

TEST(Clip, HoldsEachValueOfStepsUntilTheNext)
{
    JointTrack track{0};
    track.translation = {{{1.0, Vec3(1, 0, 0)}, {2.0, Vec3(2, 0, 0)}}, {}, Interpolation::Step};
    EXPECT_EQ(sampled(track, 0.0).translation, Vec3(1, 0, 0));
    EXPECT_EQ(sampled(track, 1.999).translation, Vec3(1, 0, 0));
    EXPECT_EQ(sampled(track, 2.0).translation, Vec3(2, 0, 0));
}

TEST(Clip, FollowsAnyCubicExactly)
{
    // f(t) = t^3 - 2 t at 1 and 3, with its derivatives.
    const auto f = [](double t) { return t * t * t - 2.0 * t; };
    const auto slope = [](double t) { return 3.0 * t * t - 2.0; };
    JointTrack track{0};
    track.translation.interpolation = Interpolation::CubicSpline;
    for (const double t : {1.0, 3.0}) {
        track.translation.keys.push_back({t, f(t) * Vec3(1, 2, 3)});
        track.translation.tangents.push_back({slope(t) * Vec3(1, 2, 3), slope(t) * Vec3(1, 2, 3)});
    }
    for (const double t : {1.0, 1.3, 2.0, 2.9, 3.0})
        EXPECT_LT((sampled(track, t).translation - f(t) * Vec3(1, 2, 3)).norm(), 1e-12) << t;
    EXPECT_EQ(sampled(track, 9.0).translation, sampled(track, 3.0).translation);
}

TEST(Clip, GivesRotationsOfLength1BetweenSplineKeys)
{
    JointTrack track{0};
    track.rotation.interpolation = Interpolation::CubicSpline;
    const Eigen::Quaterniond none(0, 0, 0, 0);
    track.rotation.keys = {{0.0, about_z(0.0)}, {1.0, about_z(2.0)}};
    track.rotation.tangents = {{none, none}, {none, none}};
    const Eigen::Quaterniond middle = sampled(track, 0.5).rotation;
    EXPECT_NEAR(middle.norm(), 1.0, 1e-15);
    EXPECT_NEAR(middle.angularDistance(about_z(1.0)), 0.0, 1e-12); // by symmetry
}

TEST(Clip, TurnsTheShorterWayBetweenKeysOfOppositeSign)
{
    JointTrack track{0};
    track.rotation.keys = {{0.0, about_z(0.2)}, {1.0, Eigen::Quaterniond(-about_z(0.6).coeffs())}};
    EXPECT_NEAR(sampled(track, 0.5).rotation.angularDistance(about_z(0.4)), 0.0, 1e-12);
}

TEST(Clip, LeavesShapesWithoutATrackAtRest)
{
    Clip clip{"clip", 1.0, {}, {{1, {{{0.0, 0.0}, {1.0, 4.0}}}}}};
    const std::vector<double> rest{0.5, 0.25};
    std::vector<double> weights(2);
    sample_shapes(clip, rest, 0.25, weights);
    EXPECT_EQ(weights, (std::vector<double>{0.5, 1.0}));
}

} // namespace toile::test
