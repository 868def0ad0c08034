#pragma once

#include "avatars/model/skeleton.h"

namespace toile::avatars {

/// Orientation and origin of every joint in the world. Orientations leave scale out: bones turn rigidly.
struct WorldPose {
    std::vector<Eigen::Quaterniond> rotation; ///< [joints]
    std::vector<Vec3> position;               ///< [joints] in the units of the world
};

/// Rotation of a map that rotates and scales evenly.
Eigen::Quaterniond rotation_of(const Affine& similarity);

/// Axis of the coordinate system, or its opposite, nearest to a direction.
Vec3 nearest_axis(const Vec3& direction);

/// @param local            [joints] transforms in the parents
/// @param world_from_file  rotates, scales evenly and translates
WorldPose world_pose(const Skeleton& skeleton, View<const JointTransform> local,
                     const Affine& world_from_file);

/// World pose of a skeleton as its file has it without a clip.
WorldPose rest_world_pose(const Skeleton& skeleton, const Affine& world_from_file);

} // namespace toile::avatars
