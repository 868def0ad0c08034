#pragma once

#include "avatars/landmarks/body_joints.h"
#include "avatars/retarget/joint_map.h"
#include "avatars/retarget/world_pose.h"

namespace toile::avatars {

/// Relation of a body's bind pose to the reference pose of a motion's skeleton, the pose that its file has
/// without a clip: a T-pose, or any other with straight limbs.
struct ReferencePose {
    /// Quarter turns that bring the axes of the motion's world (up, front) to those of the body's.
    Eigen::Quaterniond body_from_motion = Eigen::Quaterniond::Identity();

    /// [body joints] Rotation, in the body's world, of a joint from the bind pose to the reference pose:
    /// the least one that gives upper arms, forearms, thighs and shins the directions that they have there.
    /// Hands turn with their forearms. Trunk, head and feet keep the orientation of the bind pose: spines and
    /// insteps differ from body to body, but bodies stand upright on flat soles in both poses.
    std::vector<Eigen::Quaterniond> reference_from_bind;

    double metres_per_unit =
        1.0; ///< of the motion: leg lengths, else lengths of mapped bones, as the body's [m]
    Vec3 front = Vec3::UnitZ(); ///< horizontal axis that the body faces in the bind pose
};

/// @param body    bind pose in metres, Y up
/// @param motion  reference pose in the motion's units
/// @throws InvalidInput if the mapped bones of one of both have no length
ReferencePose reference_pose(const Skeleton& skeleton, const WorldPose& body, const BodyJoints& limbs,
                             const WorldPose& motion, const JointMap& source_of, const std::string& source);

} // namespace toile::avatars
