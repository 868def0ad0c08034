#include "scenes/meshes/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace toile::test {

using namespace scenes;

namespace {

RigidMotion motion_of(const std::vector<std::pair<double, double>>& heights)
{
    std::vector<scene::Keyframe> keys;
    for (const auto& [time, height] : heights) {
        keys.emplace_back();
        keys.back().time = time;
        keys.back().translate = Vec3(0, height, 0);
        keys.back().rotate_deg = Vec3(0, 90.0 * height, 0);
    }
    return {keys, Vec3::Zero()};
}

double height(const RigidMotion& motion, double t) { return motion.at(t).translation().y(); }

} // namespace

TEST(RigidMotion, IsUniformBetweenTwoKeyframes)
{
    const RigidMotion motion = motion_of({{1.0, 0.0}, {3.0, 1.0}});
    for (const double t : {0.0, 1.0, 1.3, 2.0, 3.0, 9.0})
        EXPECT_NEAR(height(motion, t), std::clamp((t - 1.0) / 2.0, 0.0, 1.0), 1e-14) << t;
    EXPECT_LT((motion.at(2.0).linear() - rotation_of(Vec3(0, 45, 0))).norm(), 1e-14);
}

TEST(RigidMotion, PassesThroughKeyframesWithoutAJumpOfSpeed)
{
    const RigidMotion motion = motion_of({{0.0, 0.0}, {0.5, 0.2}, {0.7, 0.8}, {1.5, 1.0}, {2.0, 1.0}});
    EXPECT_NEAR(height(motion, 0.7), 0.8, 1e-14);
    const double h = 1e-5;
    for (const double t : {0.5, 0.7, 1.5}) {
        const double before = (height(motion, t) - height(motion, t - h)) / h;
        const double after = (height(motion, t + h) - height(motion, t)) / h;
        EXPECT_NEAR(before, after, 1e-3) << t;
    }
}

TEST(RigidMotion, NeverOvershoots)
{
    const RigidMotion motion = motion_of({{0.0, 0.0}, {0.3, 0.0}, {0.4, 1.0}, {1.0, 1.0}, {1.1, 0.5}});
    double last = 0.0;
    for (double t = 0.0; t <= 1.0; t += 0.001) {
        const double now = height(motion, t);
        EXPECT_GE(now, last - 1e-14) << t;
        EXPECT_LE(now, 1.0 + 1e-14) << t;
        last = now;
    }
    EXPECT_EQ(height(motion, 0.2), 0.0) << "stands still between equal keyframes";
}

/// A swing sampled 30 times a second: linear interpolation is off by 1.7 mm.
TEST(RigidMotion, FollowsASampledSwing)
{
    std::vector<std::pair<double, double>> keys;
    const auto swing = [](double t) { return 0.08 * std::sin(4.0 * std::numbers::pi * t); };
    for (int k = 0; k <= 30; ++k)
        keys.emplace_back(k / 30.0, swing(k / 30.0));
    const RigidMotion motion = motion_of(keys);
    double worst = 0.0;
    for (double t = 0.1; t < 0.9; t += 0.001)
        worst = std::max(worst, std::fabs(height(motion, t) - swing(t)));
    EXPECT_LT(worst, 1.1e-3);
}

} // namespace toile::test
