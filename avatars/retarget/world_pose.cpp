#include "avatars/retarget/world_pose.h"

#include <cmath>

namespace toile::avatars {

Eigen::Quaterniond rotation_of(const Affine& similarity)
{
    const Mat3 linear = similarity.leftCols<3>();
    return Eigen::Quaterniond(Mat3(linear / std::cbrt(linear.determinant()))).normalized();
}

Vec3 nearest_axis(const Vec3& direction)
{
    int axis = 0;
    direction.cwiseAbs().maxCoeff(&axis);
    return direction[axis] < 0.0 ? Vec3(-Vec3::Unit(axis)) : Vec3(Vec3::Unit(axis));
}

WorldPose world_pose(const Skeleton& skeleton, View<const JointTransform> local,
                     const Affine& world_from_file)
{
    std::vector<Affine> frames(size_t(skeleton.size()));
    joint_frames(skeleton, local, frames);
    WorldPose pose;
    const Eigen::Quaterniond root = rotation_of(world_from_file);
    for (int j = 0; j < skeleton.size(); ++j) {
        const int parent = skeleton.joints()[size_t(j)].parent;
        const Eigen::Quaterniond& outer = parent < 0 ? root : pose.rotation[size_t(parent)];
        pose.rotation.push_back((outer * local[j].rotation).normalized());
        pose.position.push_back(apply(world_from_file, frames[size_t(j)].col(3)));
    }
    return pose;
}

WorldPose rest_world_pose(const Skeleton& skeleton, const Affine& world_from_file)
{
    const std::vector<JointTransform> rest = skeleton.rest_pose();
    return world_pose(skeleton, rest, world_from_file);
}

} // namespace toile::avatars
