#pragma once

#include <random>

#include "avatars/model/skeletal_motion.h"
#include "avatars/retarget/world_pose.h"

namespace toile::test {

using namespace avatars;

/// A human skeleton with the joints of the CMU library, built from positions in the world.
struct Figure {
    double leg = 0.4;             ///< of thigh and of shin
    double arm_drop_deg = 0.0;    ///< of both arms below the horizontal: 0 is a T-pose
    double leg_spread_deg = 0.0;  ///< of each leg from the vertical
    double facing_deg = 0.0;      ///< about Y from +Z
    bool has_random_axes = false; ///< of the joints; else they are parallel to the world's
};

inline Eigen::Quaterniond rotation(double angle_deg, const Vec3& axis)
{
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_deg * EIGEN_PI / 180.0, axis.normalized()));
}

inline Eigen::Quaterniond random_rotation(std::mt19937& generator, double max_deg)
{
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const Vec3 axis(unit(generator), unit(generator), unit(generator));
    return rotation(max_deg * unit(generator), axis);
}

inline Skeleton skeleton_of(const Figure& figure)
{
    std::mt19937 generator(7);
    Skeleton skeleton;
    std::vector<Vec3> position;
    std::vector<Eigen::Quaterniond> axes;
    const Eigen::Quaterniond facing = rotation(figure.facing_deg, Vec3::UnitY());
    const auto add = [&](const std::string& name, const std::string& parent_name, const Vec3& offset) {
        const int parent = parent_name.empty() ? -1 : skeleton.find(parent_name);
        const Vec3 from = parent < 0 ? Vec3(Vec3::Zero()) : position[size_t(parent)];
        const Eigen::Quaterniond outer = parent < 0 ? Eigen::Quaterniond::Identity() : axes[size_t(parent)];
        position.push_back(from + facing * offset);
        axes.push_back(figure.has_random_axes ? random_rotation(generator, 180.0)
                                              : Eigen::Quaterniond::Identity());
        skeleton.add(
            {name, parent, {outer.conjugate() * (position.back() - from), outer.conjugate() * axes.back()}});
    };
    add("Hips", "", {0.0, 2.0 * figure.leg + 0.15, 0.0});
    add("LowerBack", "Hips", {0.0, 0.05, -0.02});
    add("Spine", "LowerBack", {0.0, 0.15, 0.0});
    add("Spine1", "Spine", {0.0, 0.15, 0.01});
    add("Neck", "Spine1", {0.0, 0.15, 0.0});
    add("Neck1", "Neck", {0.0, 0.05, 0.02});
    add("Head", "Neck1", {0.0, 0.05, 0.01});
    for (const double side : {1.0, -1.0}) {
        const std::string name = side > 0.0 ? "Left" : "Right";
        const Vec3 arm = rotation(-side * figure.arm_drop_deg, Vec3::UnitZ()) * Vec3(0.28 * side, 0.0, 0.0);
        const Vec3 leg = rotation(side * figure.leg_spread_deg, Vec3::UnitZ()) * Vec3(0.0, -figure.leg, 0.0);
        add(name + "Shoulder", "Spine1", {0.03 * side, 0.1, 0.0});
        add(name + "Arm", name + "Shoulder", {0.14 * side, 0.0, 0.0});
        add(name + "ForeArm", name + "Arm", arm);
        add(name + "Hand", name + "ForeArm", arm);
        add(name + "UpLeg", "Hips", {0.1 * side, -0.05, 0.0});
        add(name + "Leg", name + "UpLeg", leg);
        add(name + "Foot", name + "Leg", leg);
        add(name + "ToeBase", name + "Foot", {0.0, -0.06, 0.13});
    }
    return skeleton;
}

/// Clip that moves every joint by random rotations of up to 60 degrees between keys, and the hips along Z.
/// The hips keep their orientation at the first key.
inline Clip random_clip(const Skeleton& skeleton, const std::vector<double>& times, double travel)
{
    std::mt19937 generator(3);
    Clip clip{"moves", times.back()};
    for (int j = 0; j < skeleton.size(); ++j) {
        const JointTransform& rest = skeleton.joints()[size_t(j)].rest;
        JointTrack track{j};
        for (const double time : times) {
            const Eigen::Quaterniond turn = j == 0 && time == times.front()
                                                ? Eigen::Quaterniond::Identity()
                                                : random_rotation(generator, 60.0);
            track.rotation.keys.push_back({time, rest.rotation * turn});
            if (j == 0)
                track.translation.keys.push_back(
                    {time, rest.translation + travel * time * Vec3(0.3, 0.1 * time, 1.0)});
        }
        clip.tracks.push_back(std::move(track));
    }
    return clip;
}

inline WorldPose pose_at(const Skeleton& skeleton, const Clip& clip, double time,
                         const Affine& world = identity_affine())
{
    std::vector<JointTransform> local(size_t(skeleton.size()));
    sample(clip, skeleton, time, local);
    return world_pose(skeleton, local, world);
}

/// Direction from one joint to another.
inline Vec3 direction(const Skeleton& skeleton, const WorldPose& pose, const std::string& from,
                      const std::string& to)
{
    return (pose.position[size_t(skeleton.find(to))] - pose.position[size_t(skeleton.find(from))])
        .normalized();
}

} // namespace toile::test
