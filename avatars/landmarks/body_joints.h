#pragma once

#include <array>
#include <string>
#include <vector>

#include "avatars/landmarks/body_landmarks.h"
#include "avatars/model/skeleton.h"

namespace toile::avatars {

/// Joints of a human skeleton, as indices; -1 for those that it lacks.
struct BodyJoints {
    struct Limb {
        int start = -1;  ///< shoulder or hip
        int middle = -1; ///< elbow or knee
        int end = -1;    ///< wrist or ankle
        bool is_whole() const { return start >= 0 && middle >= 0 && end >= 0; }
    };
    std::array<Limb, 2> arm; ///< by Side
    std::array<Limb, 2> leg; ///< by Side
    int neck = -1;
    int head = -1;

    bool is_whole() const;
    /// Names of what is missing, for messages: "left arm, neck".
    std::string missing() const;
};

/// Finds joints by their names, as Mixamo, CMU, SMPL, Blender, 3ds Max and Unreal call them: LeftForeArm,
/// mixamorig:LeftForeArm, LeftElbow, L_Elbow, lower_arm.L, "Bip01 L Forearm", lowerarm_l.
BodyJoints joints_by_name(const Skeleton& skeleton);

/// Finds joints by the tree alone: legs are the two lowest limbs, which part at the pelvis; arms the pair
/// that parts from the spine below the head, its highest joint.
/// @param position  [joints] in the bind pose, Y up [m]
BodyJoints joints_by_tree(const Skeleton& skeleton, const std::vector<Vec3>& position);

/// Joints from the root to `joint`, both included.
std::vector<int> path_from_root(const Skeleton& skeleton, int joint);

/// 1 for a joint and all that follow it. [joints]
std::vector<char> subtree(const Skeleton& skeleton, int root);

} // namespace toile::avatars
