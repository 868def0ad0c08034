#pragma once

#include "avatars/landmarks/body_joints.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Frames of a body's joints in the world [m].
/// @param local  [joints]
std::vector<Affine> frames_in_world(const RiggedModel& body, View<const JointTransform> local);

/// Points of the feet that touch the floor first: the skin of the feet, each vertex with its heaviest bone;
/// of a body without skin there the joints of the feet.
class FootSoles {
public:
    /// @param limbs  legs that are missing have no feet
    FootSoles(const RiggedModel& body, const BodyJoints& limbs);

    bool empty() const { return points_.empty(); }

    /// Height of the lowest point over the floor on which the feet stand in the bind pose [m].
    /// @param frames  [joints] of a pose, as frames_in_world()
    double height(const std::vector<Affine>& frames) const;

private:
    struct Point {
        int joint = -1;
        Vec3 in_joint = Vec3::Zero(); ///< in the joint's frame
        double floor = 0.0;           ///< height in the world at which it touches the floor [m]
    };
    void add_skin(const RiggedModel& body, const std::vector<char>& is_foot);

    std::vector<Point> points_;
};

} // namespace toile::avatars
