#pragma once

#include <memory>

#include "avatars/avatar.h"
#include "avatars/motion.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Where an avatar stands: x_world = translate + R (scale x), R = Rz Ry Rx (turned about the fixed X axis
/// first, then Y, then Z).
struct Placement {
    Vec3 translate = Vec3::Zero();  ///< [m]
    Vec3 rotate_deg = Vec3::Zero(); ///< angles about X, Y and Z
    double scale = 1.0;             ///< [-] must be positive

    Affine world_from_avatar() const;
};

/// An avatar that plays a motion at a place: the moving obstacle of a simulation.
class MovingAvatar {
public:
    /// Shows the pose at t = 0, standing still.
    /// @throws InvalidInput for a clip the avatar does not have and for settings out of range.
    MovingAvatar(std::unique_ptr<Avatar> avatar, Motion motion, const Placement& placement);

    /// Makes the end of the last step the start of this one and poses its end at simulation time t_t1 [s].
    /// A pose equal to the last one (held, ended, static) is not computed again.
    void advance_to(double t_t1);

    const MovingMesh& mesh() const { return mesh_; }
    const Avatar& avatar() const { return *avatar_; }

    /// True when it never moves: no clip, or a frozen one.
    bool is_static() const { return shows_one_pose(motion_); }

    /// False when x_t0 equals x_t1 in the current step.
    bool moved() const { return moved_; }

private:
    PoseAt at(double t) const;

    std::unique_ptr<Avatar> avatar_;
    Motion motion_;
    int clip_ = -1;
    Affine world_from_avatar_;
    PoseAt shown_; ///< at x_t1
    bool moved_ = false;
    MovingMesh mesh_;
};

} // namespace toile
