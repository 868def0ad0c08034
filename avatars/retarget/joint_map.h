#pragma once

#include <filesystem>

#include "avatars/model/skeletal_motion.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Joint of a motion's skeleton that drives each joint of a body; -1 for those that follow their parents.
/// [body joints]
using JointMap = std::vector<int>;

/// Joints of equal names.
JointMap map_by_names(const Skeleton& body, const SkeletalMotion& motion);

/// Built-in map from a CMU skeleton, see CmuJoints, to a body with arms, legs, neck and head, whose joints
/// are found as by find_joints(). Spines of other lengths share the turns of the three joints of the CMU
/// spine evenly.
/// @throws InvalidInput naming the first joint that the motion lacks, or the limb that the body lacks
JointMap map_from_cmu(SkinnedAvatar& body, const SkeletalMotion& motion);

/// Reads a map {"joint of the body": "joint of the motion", ...} from a JSON file.
/// @throws InvalidInput naming the entry and the nearest joint
JointMap read_joint_map(const std::filesystem::path& file, const SkinnedAvatar& body,
                        const SkeletalMotion& motion);

} // namespace toile::avatars
