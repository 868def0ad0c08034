#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "collision/geometry/shapes.h"
#include "scenes/colliders/skinned_collider.h"
#include "scenes/meshes/rigid_motion.h"

namespace toile::scenes {

/// Motion of an avatar of a scene: a shape, or a skinned collider whose vertices are posed on demand. Movable
/// but not copyable: a skinned collider has one owner, which advances it.
class BodyMotion {
public:
    /// Loads the avatar and poses it at t = 0.
    /// @throws InvalidInput for files, clips and bones that do not work.
    explicit BodyMotion(const scene::Avatar& settings);
    BodyMotion(BodyMotion&&) = default;
    BodyMotion& operator=(BodyMotion&&) = default;

    const scene::Avatar& settings() const { return settings_; }

    /// True if it never moves.
    bool is_static() const { return motion_.is_static() && (!skinned_ || skinned_->is_static()); }

    /// Advances to the step that starts at the end of the last one and ends at t [s].
    /// @return false if both poses are equal
    bool advance_to(double t);

    /// Largest displacement of any of its points from the end of the last step to time t [s], relative to the
    /// one that cloth can follow in a step: half the thickness of a limb or of a shape, beyond which cloth
    /// would leave on the other side. No step is taken. [-]
    double motion_to(double t);

    /// Shape of an avatar given as plane, sphere, capsule or box; else null.
    const collision::Shape* shape() const { return shape_ ? &*shape_ : nullptr; }
    const Eigen::Isometry3d& pose() const { return pose_; } ///< world_from_shape at the step's end

    /// Skinned collider of any other avatar; null for a shape.
    std::shared_ptr<const SkinnedCollider> skinned() const { return skinned_; }

private:
    scene::Avatar settings_;
    std::optional<collision::Shape> shape_;
    RigidMotion motion_;
    Eigen::Isometry3d start_pose_ = Eigen::Isometry3d::Identity(); ///< of a shape
    Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
    std::shared_ptr<SkinnedCollider> skinned_;
};

} // namespace toile::scenes
