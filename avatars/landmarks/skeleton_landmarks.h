#pragma once

#include <vector>

#include "avatars/landmarks/body_joints.h"
#include "avatars/landmarks/body_segments.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// A body with bones in one pose, with the part that each vertex belongs to.
struct PosedSkeleton {
    BodyJoints joints;
    std::vector<Vec3> position; ///< [joints] [m]; joints without bone are at their nearest parent with one
    std::vector<BodyPart> part; ///< [vertices] by the bone of the largest weight
    std::vector<Vec3> vertices; ///< [vertices] [m]
};

/// Joints by their names, else by the shape of the tree.
/// @throws InvalidInput naming the limbs whose joints can't be told
BodyJoints find_joints(SkinnedAvatar& avatar);

/// @throws InvalidInput naming the limbs whose joints can't be told
PosedSkeleton pose_skeleton(SkinnedAvatar& avatar, const PoseAt& at, const Affine& world_from_avatar);

/// Landmarks in the pose. Joints are as the skeleton has them; the crotch is the lowest skin between the
/// thighs, and the top of a leg the middle of the thigh's skin at that level.
BodyLandmarks landmarks_of(const PosedSkeleton& skeleton);

} // namespace toile::avatars
