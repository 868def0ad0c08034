#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::avatars {

/// An affine map as the 3x4 matrix [A | b]: x -> A x + b.
using Affine = Eigen::Matrix<double, 3, 4>;

inline Affine identity_affine() { return Affine::Identity(); }

/// outer after inner: x -> outer(inner(x)).
Affine compose(const Affine& outer, const Affine& inner);
Affine inverse(const Affine& map);
inline Vec3 apply(const Affine& map, const Vec3& x) { return map.leftCols<3>() * x + map.col(3); }

/// Transform of a joint in its parent: scale, then rotation, then translation. Kept in parts because motion
/// is interpolated in parts.
struct JointTransform {
    Vec3 translation = Vec3::Zero(); ///< in the parent's units
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 scale = Vec3::Ones(); ///< [-]

    Affine matrix() const;
};

/// Interpolates the parts separately: translation and scale linearly, rotation along the shorter great
/// circle.
/// weight = 0 gives a, 1 gives b.
JointTransform blend(const JointTransform& a, const JointTransform& b, double weight);

struct Joint {
    std::string name;
    int parent = -1;     ///< index of an earlier joint, or -1
    JointTransform rest; ///< in the bind pose
};

/// A tree of joints, parents before children.
class Skeleton {
public:
    /// @throws InvalidInput if the parent is not an earlier joint.
    int add(Joint joint);

    const std::vector<Joint>& joints() const { return joints_; }
    int size() const { return int(joints_.size()); }

    /// Index of the joint of that name, the first one if the file repeats it; -1 if there is none.
    int find(const std::string& name) const;

    /// Index as from find(), for a name that `user` (a mesh, an animation channel) requires.
    /// @throws InvalidInput naming `user`, the missing joint and the nearest existing name.
    int require(const std::string& name, const std::string& user) const;

    std::vector<JointTransform> rest_pose() const;

private:
    std::vector<Joint> joints_;
    std::map<std::string, int> index_of_;
};

/// Joint frames in avatar space from transforms in their parents.
/// @param local  [joints]
/// @param out    [joints] avatar_from_joint
void joint_frames(const Skeleton& skeleton, View<const JointTransform> local, View<Affine> out);

} // namespace toile::avatars
