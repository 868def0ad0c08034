#include "avatars/retarget/retarget.h"

#include <gtest/gtest.h>

#include "avatars/retarget/cmu_skeleton.h"
#include "core/base/error.h"
#include "tests/avatars/retarget/figures.h"

namespace toile::test {

namespace {

using Eigen::Quaterniond;

const std::vector<std::pair<std::string, std::string>> kLimbBones{
    {"LeftArm", "LeftForeArm"}, {"LeftForeArm", "LeftHand"},  {"LeftUpLeg", "LeftLeg"},
    {"LeftLeg", "LeftFoot"},    {"RightArm", "RightForeArm"}, {"RightForeArm", "RightHand"},
    {"RightUpLeg", "RightLeg"}, {"RightLeg", "RightFoot"}};

/// Result of retargeting between figures by the names of their joints.
struct Retargeted {
    RiggedModel body;
    SkeletalMotion motion;
    Clip clip;

    Retargeted(const Figure& body_figure, const Figure& motion_figure, const std::vector<double>& times,
               double travel = 1.0)
    {
        body.skeleton = skeleton_of(body_figure);
        motion = {"motion", skeleton_of(motion_figure), {}};
        motion.clips.push_back(random_clip(motion.skeleton, times, travel));
        run();
    }

    void run()
    {
        clip = retarget(body, joints_by_name(body.skeleton), motion, motion.clips[0],
                        map_by_names(body.skeleton, motion),
                        rest_world_pose(motion.skeleton, identity_affine()));
    }

    WorldPose body_at(double time) const { return pose_at(body.skeleton, clip, time, body.metres_from_file); }
    WorldPose motion_at(double time) const { return pose_at(motion.skeleton, motion.clips[0], time); }
    size_t hips() const { return size_t(body.skeleton.find("Hips")); }
};

/// Quarter turn by which the figure that faces +X faces +Z.
const Quaterniond kToFront = rotation(-90.0, Vec3::UnitY());
const Figure kAPose{.leg = 0.38, .arm_drop_deg = 45.0, .leg_spread_deg = 6.0};
const Figure kTPose{.leg = 6.5, .facing_deg = 90.0, .has_random_axes = true};
const std::vector<double> kTimes{0.5, 1.0, 1.25};

} // namespace

TEST(Retarget, GivesLimbsTheDirectionsOfTheSource)
{
    const Retargeted result(kAPose, kTPose, kTimes);
    for (const double time : kTimes)
        for (const auto& [from, to] : kLimbBones) {
            const Vec3 expected =
                kToFront * direction(result.motion.skeleton, result.motion_at(time), from, to);
            const Vec3 found = direction(result.body.skeleton, result.body_at(time - kTimes[0]), from, to);
            EXPECT_LT((found - expected).norm(), 1e-9) << from << " at " << time;
        }
}

TEST(Retarget, TurnsTrunkHeadAndFeetAsTheSource)
{
    const Retargeted result(kAPose, kTPose, kTimes);
    const WorldPose bind = rest_world_pose(result.body.skeleton, identity_affine());
    const WorldPose rest = rest_world_pose(result.motion.skeleton, identity_affine());
    for (const char* name : {"Hips", "Spine1", "Neck", "Head", "LeftFoot", "RightToeBase"}) {
        const auto b = size_t(result.body.skeleton.find(name)), m = size_t(result.motion.skeleton.find(name));
        for (const double time : kTimes) {
            const Quaterniond of_body =
                result.body_at(time - kTimes[0]).rotation[b] * bind.rotation[b].conjugate();
            const Quaterniond of_motion = result.motion_at(time).rotation[m] * rest.rotation[m].conjugate();
            EXPECT_LT(of_body.angularDistance(kToFront * of_motion * kToFront.conjugate()), 1e-7) << name;
        }
    }
}

TEST(Retarget, ScalesTheTravelOfTheRootByLegLengths)
{
    const Retargeted result(kAPose, kTPose, kTimes);
    const Vec3 start = result.body_at(0.0).position[result.hips()];
    const Vec3 source_start = result.motion_at(kTimes[0]).position[result.hips()];
    for (const double time : kTimes) {
        const Vec3 travel = result.body_at(time - kTimes[0]).position[result.hips()] - start;
        const Vec3 source = result.motion_at(time).position[result.hips()] - source_start;
        EXPECT_LT((travel - 0.38 / 6.5 * (kToFront * source)).norm(), 1e-9);
    }
}

TEST(Retarget, BeginsWhereAndAsTheBodyStands)
{
    const Retargeted original({}, {}, kTimes);
    // Turn and move the whole source; the body must not notice.
    for (const double angle_deg : {115.0, 180.0}) {
        Retargeted result = original;
        const Quaterniond turn = rotation(angle_deg, Vec3::UnitY());
        JointTrack& hips = result.motion.clips[0].tracks[0];
        for (Key<Quaterniond>& key : hips.rotation.keys)
            key.value = turn * key.value;
        for (Key<Vec3>& key : hips.translation.keys)
            key.value = turn * key.value + Vec3(3.0, -2.0, 5.0);
        result.run();
        for (const double time : kTimes) {
            const WorldPose a = original.body_at(time - kTimes[0]);
            const WorldPose b = result.body_at(time - kTimes[0]);
            for (size_t j = 0; j < a.position.size(); ++j)
                EXPECT_LT((a.position[j] - b.position[j]).norm(), 1e-9) << j;
        }
        const Vec3 start = result.body_at(0.0).position[0];
        EXPECT_NEAR(start.x(), 0.0, 1e-12);
        EXPECT_NEAR(start.z(), 0.0, 1e-12);
    }
}

TEST(Retarget, MovesABodyOfOtherUnitsAndAxesAlike)
{
    const Retargeted in_metres(kAPose, kTPose, kTimes);
    Retargeted other = in_metres;
    // The same body in centimetres with Z up: positions turned by 90 degrees about X.
    const Quaterniond z_up = rotation(90.0, Vec3::UnitX());
    Skeleton skeleton;
    for (Joint joint : in_metres.body.skeleton.joints()) {
        joint.rest.translation *= 100.0;
        if (joint.parent < 0)
            joint.rest = {z_up * joint.rest.translation, z_up * joint.rest.rotation, joint.rest.scale};
        skeleton.add(std::move(joint));
    }
    other.body.skeleton = skeleton;
    other.body.metres_from_file.leftCols<3>() = 0.01 * z_up.conjugate().toRotationMatrix();
    other.run();
    for (const double time : {0.0, 0.3, 0.75})
        for (size_t j = 0; j < size_t(skeleton.size()); ++j)
            EXPECT_LT((other.body_at(time).position[j] - in_metres.body_at(time).position[j]).norm(), 1e-9);
}

TEST(Retarget, KeepsFeetOnTheFloorOfTheBindPose)
{
    std::vector<double> times;
    for (int k = 0; k <= 100; ++k)
        times.push_back(k / 60.0);
    const Retargeted result(kAPose, kTPose, times, 0.0);
    const WorldPose bind = rest_world_pose(result.body.skeleton, identity_affine());
    int below = 0;
    double nearest = 1.0;
    for (const double time : times) {
        double lowest = 1.0;
        for (const char* name : {"LeftFoot", "RightFoot", "LeftToeBase", "RightToeBase"}) {
            const auto j = size_t(result.body.skeleton.find(name));
            lowest = std::min(lowest, result.body_at(time).position[j].y() - bind.position[j].y());
        }
        below += lowest < -1e-9 ? 1 : 0;
        nearest = std::min(nearest, std::abs(lowest));
    }
    EXPECT_EQ(below, 10); // of 101 samples, a tenth
    EXPECT_LT(nearest, 1e-9);
}

TEST(Retarget, LeavesOutAFirstKeyInTheReferencePose)
{
    // Both arms are raised by 60 degrees, within a frame or within a second.
    for (const double rise : {1.0 / 120.0, 1.0}) {
        Retargeted result({}, {}, kTimes);
        Clip& clip = result.motion.clips[0];
        clip = {"raise", 2.0};
        for (const char* name : {"LeftArm", "RightArm"}) {
            JointTrack track{result.motion.skeleton.find(name)};
            const Quaterniond raised = rotation(name[0] == 'L' ? 60.0 : -60.0, Vec3::UnitZ());
            track.rotation.keys = {{0.0, Quaterniond::Identity()}, {rise, raised}, {2.0, raised}};
            clip.tracks.push_back(track);
        }
        result.run();
        const bool is_left_out = rise < 0.5;
        EXPECT_NEAR(result.clip.duration, is_left_out ? 2.0 - rise : 2.0, 1e-12);
        const Vec3 arm = direction(result.body.skeleton, result.body_at(0.0), "LeftArm", "LeftForeArm");
        EXPECT_NEAR(arm.y(), is_left_out ? std::sin(EIGEN_PI / 3.0) : 0.0, 1e-9);
    }
}

TEST(Retarget, MovesArmsAloneWithoutARoot)
{
    Retargeted result(kAPose, kTPose, kTimes);
    JointMap map(size_t(result.body.skeleton.size()), -1);
    for (const char* name : {"LeftArm", "LeftForeArm", "RightArm"})
        map[size_t(result.body.skeleton.find(name))] = result.motion.skeleton.find(name);
    const Clip clip =
        retarget(result.body, joints_by_name(result.body.skeleton), result.motion, result.motion.clips[0],
                 map, rest_world_pose(result.motion.skeleton, identity_affine()));
    EXPECT_EQ(clip.tracks.size(), 3u);
    for (const JointTrack& track : clip.tracks)
        EXPECT_TRUE(track.translation.keys.empty());
}

TEST(Retarget, RefusesAMapOfNothing)
{
    const Retargeted result({}, {}, kTimes);
    const JointMap none(size_t(result.body.skeleton.size()), -1);
    EXPECT_THROW(retarget(result.body, {}, result.motion, result.motion.clips[0], none,
                          rest_world_pose(result.motion.skeleton, identity_affine())),
                 InvalidInput);
}

TEST(CmuSkeleton, StandsOnLegsTurnedUpright)
{
    const Skeleton skeleton = skeleton_of({.leg_spread_deg = 20.0});
    const WorldPose rest = rest_world_pose(skeleton, identity_affine());
    const WorldPose pose = standing_pose(skeleton, cmu_joints(skeleton));
    EXPECT_LT((direction(skeleton, pose, "LeftUpLeg", "LeftFoot") + Vec3::UnitY()).norm(), 1e-12);
    const auto foot = size_t(skeleton.find("RightToeBase")), hand = size_t(skeleton.find("RightHand"));
    EXPECT_NEAR(pose.rotation[foot].angularDistance(rest.rotation[foot]), EIGEN_PI / 9.0, 1e-12);
    EXPECT_EQ(pose.position[hand], rest.position[hand]);
}

} // namespace toile::test
