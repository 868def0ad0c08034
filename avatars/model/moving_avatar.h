#pragma once

#include <memory>
#include <optional>

#include "avatars/model/avatar.h"
#include "avatars/model/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Similarity transform of an avatar: x_world = translate + R (scale x), R = Rz Ry Rx (rotation about the
/// fixed X axis first, then Y, then Z).
struct Placement {
    Vec3 translate = Vec3::Zero();  ///< [m]
    Vec3 rotate_deg = Vec3::Zero(); ///< angles about X, Y and Z
    double scale = 1.0;             ///< [-] must be positive

    Affine world_from_avatar() const;
};

/// Avatar that plays a motion at a placement: the moving collider of a simulation. It stores its bones at
/// both ends of a step. Its users pose the vertices, on the host or on the device.
class MovingAvatar {
public:
    /// Shows the pose at t = 0, without motion.
    /// @param root_transform  see advance_to()
    /// @throws InvalidInput for a clip the avatar does not have and for settings out of range.
    MovingAvatar(std::unique_ptr<Avatar> avatar, Motion motion, const Placement& placement,
                 const Affine& root_transform = identity_affine());

    /// Makes the end of the last step the start of this one and poses the bones at its end, simulation time
    /// t_t1 [s]. A pose equal to the last one (held, ended, static) is not computed again.
    /// @param root_transform  moves the whole avatar: x_world = root_transform(placement(x))
    void advance_to(double t_t1, const Affine& root_transform = identity_affine());

    /// Bound on the displacement of any vertex from the end of the last step to time t [s], without a step
    /// [m].
    double max_motion_to(double t, const Affine& root_transform = identity_affine());

    const Avatar& avatar() const { return *avatar_; }

    /// Pose at simulation time t [s], without its root transform and the travel of full cycles.
    PoseAt shape_at(double t) const;
    /// Computes the bones of such a pose. @param bones  [avatar().bone_count()] out
    void pose_bones(const PoseAt& at, View<Affine> bones) const
    {
        avatar_->pose_bones(at, world_from_avatar_, bones);
    }

    /// Bones at the step's start and end, for avatar().skin(). [avatar().bone_count()]
    View<const Affine> bones_t0() const { return bones_t0_; }
    View<const Affine> bones_t1() const { return bones_t1_; }

    /// True if the avatar never moves by itself: no clip, or a frozen one.
    bool is_static() const { return shows_one_pose(motion_); }

    /// Simulation time [s] from which on it shows the last pose of its clip; none if it never does.
    std::optional<double> end_time() const;

    /// False if both ends of the current step are equal.
    bool moved() const { return moved_; }

private:
    PoseAt at(double t) const;
    void show(const PoseAt& at, const Affine& root_transform);

    std::unique_ptr<Avatar> avatar_;
    Motion motion_;
    int clip_ = -1;
    Affine world_from_avatar_;
    PoseAt shown_;                ///< at t1
    Affine shown_root_transform_; ///< root transform at t1
    bool moved_ = false;
    std::vector<Affine> bones_t0_, bones_t1_;

    // State of max_motion_to(). A step to the pose that it has looked at takes its bones.
    std::vector<Bounds> bone_boxes_; ///< [bones] around the rest positions of a bone's vertices; empty: unset
    std::vector<double> shape_reaches_; ///< [shapes] longest displacement by a shape of weight 1
    std::vector<Affine> bones_ahead_;
    PoseAt ahead_;
    Affine ahead_root_transform_;
    bool is_posed_ahead_ = false; ///< bones_ahead_ are those of the two
};

} // namespace toile::avatars
