#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "core/backend/types.h"

namespace toile {

/// An affine map as the 3x4 matrix [A | b]: x -> A x + b.
using Affine = Eigen::Matrix<double, 3, 4>;

inline Affine identity_affine() { return Affine::Identity(); }

/// outer after inner: x -> outer(inner(x)).
Affine compose(const Affine& outer, const Affine& inner);
Affine inverse(const Affine& map);
inline Vec3 apply(const Affine& map, const Vec3& x) { return map.leftCols<3>() * x + map.col(3); }

/// A joint's place in its parent: scale, then rotate, then translate. Kept in parts because motion is
/// interpolated in parts.
struct JointTransform {
    Vec3 translation = Vec3::Zero(); ///< in the parent's units
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 scale = Vec3::Ones(); ///< [-]

    Affine matrix() const;
};

/// Parts interpolated on their own: translation and scale linearly, rotation along the shorter great circle.
/// share = 0 gives a, 1 gives b.
JointTransform blend(const JointTransform& a, const JointTransform& b, double share);

struct Joint {
    std::string name;
    int parent = -1;     ///< index of an earlier joint, or -1
    JointTransform rest; ///< in the bind pose
};

/// A tree of joints, parents before children.
class Skeleton {
public:
    /// @throws InvalidInput when the parent is not an earlier joint.
    int add(Joint joint);

    const std::vector<Joint>& joints() const { return joints_; }
    int size() const { return int(joints_.size()); }

    /// The joint of that name, the first one if the file repeats it; -1 for none.
    int find(const std::string& name) const;

    /// As find, for a name that `user` (a mesh, an animation channel) relies on.
    /// @throws InvalidInput naming `user`, the missing joint and the nearest name there is.
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

} // namespace toile
