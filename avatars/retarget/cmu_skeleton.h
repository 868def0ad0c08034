#pragma once

#include <array>

#include "avatars/landmarks/body_joints.h"
#include "avatars/retarget/world_pose.h"

namespace toile::avatars {

/// Joints of a skeleton of the CMU motion library by their part, under either of its naming schemes
/// (LeftUpLeg, LeftArm, ... and LeftHip, LeftShoulder, ...); -1 for those that it lacks.
struct CmuJoints {
    int pelvis = -1;
    std::array<int, 3> spine{}; ///< upwards
    std::array<int, 2> neck{};
    int head = -1;
    std::array<std::array<int, 3>, 2> arm{}; ///< by Side: shoulder, elbow, wrist
    std::array<std::array<int, 4>, 2> leg{}; ///< by Side: hip, knee, ankle, ball of the foot
    std::string missing;                     ///< name of the first that it lacks; empty: it is a CMU skeleton
};

CmuJoints cmu_joints(const Skeleton& skeleton);

/// Pose in which a CMU skeleton stands upright on flat soles: that of its file with the legs turned upright.
/// Without rotations the legs of most of these files are 20 degrees apart and the feet tilted with them.
WorldPose standing_pose(const Skeleton& skeleton, const CmuJoints& joints);

} // namespace toile::avatars
