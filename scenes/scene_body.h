#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "avatars/moving_avatar.h"
#include "collision/shapes.h"
#include "scenes/contact_surface.h"
#include "scenes/format/scene.h"
#include "scenes/rigid_motion.h"

namespace toile {

/// An avatar of a scene at a time that can be chosen: what checks and pictures need, without the cloth.
class SceneBody {
public:
    /// Loads the avatar and shows it at t = 0.
    /// @throws InvalidInput for files, clips and bones that do not work.
    explicit SceneBody(const scene::Avatar& settings);

    const scene::Avatar& settings() const { return settings_; }

    /// True when it never moves.
    bool is_static() const { return motion_.is_static() && (!figure_ || figure_->is_static()); }

    /// Shows time t [s]. False when nothing moved since the time shown before.
    bool advance_to(double t);

    /// The solid at the time shown, for avatars given as plane, sphere, capsule or box.
    const Shape* shape() const { return shape_ ? &*shape_ : nullptr; }
    const Eigen::Isometry3d& pose() const { return pose_; } ///< world_from_shape

    /// The surface at the time shown: of a shape a tessellation for pictures.
    const TriangleMesh& surface() const { return surface_; }

    /// What cloth touches of it: all, but for faces of excluded bones (ContactSurface).
    const TriangleMesh& contact_surface() const { return contact_ ? contact_->mesh() : surface_; }

    /// The surface's number of a face of the contact surface, -1 where that is a lid over a cut.
    int face_of(int contact_triangle) const
    {
        return contact_ ? contact_->face_of(contact_triangle) : contact_triangle;
    }

private:
    void exclude_bones();
    void place();

    scene::Avatar settings_;
    std::optional<Shape> shape_;
    std::unique_ptr<MovingAvatar> figure_; ///< null for a shape
    RigidMotion motion_;
    Eigen::Isometry3d start_pose_ = Eigen::Isometry3d::Identity();
    Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
    std::vector<Vec3> start_surface_; ///< [vertices] in the shape's own frame, or as the figure stands [m]
    TriangleMesh surface_;
    std::optional<ContactSurface> contact_; ///< none: all of surface_
    double time_ = 0.0;
};

std::vector<SceneBody> make_bodies(const Scene& scene);

} // namespace toile
