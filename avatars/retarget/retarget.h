#pragma once

#include "avatars/landmarks/body_joints.h"
#include "avatars/retarget/joint_map.h"
#include "avatars/retarget/world_pose.h"

namespace toile::avatars {

/// Carries a clip of one skeleton over to a body with another.
///
///   R_j(t) = Q G D_s(t) G^T A_j R_j,        D_s(t) = R_s(t) R_s^T,        s = source_of[j]
///
/// R_j, R_s: without argument the orientations in the body's bind pose and in the motion's reference pose, in
/// the world; G, A_j: see ReferencePose, which also scales the root's travel by the ratio of leg lengths;
/// Q: rotation about the vertical by which the body begins as it stands in its bind pose, where it stands.
/// Joints without source keep their bind pose in their parents.
///
/// The feet are put on the floor of the bind pose: their skin is lower than there in a tenth of the time,
/// see FootSoles. A first key in the reference pose, from which the motion jumps, is left out.
/// @param limbs      of the body; any may be missing, and are then not aligned
/// @param reference  pose of the motion's skeleton, in its units, in which it stands as the body in its bind
///                   pose but for the directions of arms and legs
/// @return clip of the body's skeleton, with a key at those of the source and at least 60 a second
/// @throws InvalidInput for a map without joints, or bones without length
Clip retarget(const RiggedModel& body, const BodyJoints& limbs, const SkeletalMotion& motion,
              const Clip& clip, const JointMap& source_of, const WorldPose& reference);

} // namespace toile::avatars
