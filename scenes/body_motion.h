#pragma once

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "collision/shapes.h"
#include "scenes/figure.h"
#include "scenes/rigid_motion.h"

namespace toile {

/// An avatar of a scene in motion: a solid, or a figure whose vertices are posed by whoever needs them.
/// Moved, not copied: a figure has one owner who advances it.
class BodyMotion {
public:
    /// Loads the avatar and shows it at t = 0.
    /// @throws InvalidInput for files, clips and bones that do not work.
    explicit BodyMotion(const scene::Avatar& settings);
    BodyMotion(BodyMotion&&) = default;
    BodyMotion& operator=(BodyMotion&&) = default;

    const scene::Avatar& settings() const { return settings_; }

    /// True when it never moves.
    bool is_static() const { return motion_.is_static() && (!figure_ || figure_->is_static()); }

    /// The end of the last step becomes the start of this one, which ends at t [s]. False when both are the
    /// same.
    bool advance_to(double t);

    /// For avatars given as plane, sphere, capsule or box; else null.
    const Shape* shape() const { return shape_ ? &*shape_ : nullptr; }
    const Eigen::Isometry3d& pose() const { return pose_; } ///< world_from_shape at the step's end

    /// All others; null for a shape.
    std::shared_ptr<const Figure> figure() const { return figure_; }

private:
    scene::Avatar settings_;
    std::optional<Shape> shape_;
    RigidMotion motion_;
    Eigen::Isometry3d start_pose_ = Eigen::Isometry3d::Identity(); ///< of a shape
    Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
    std::shared_ptr<Figure> figure_;
};

} // namespace toile
