#pragma once

#include <vector>

#include "scenes/body_motion.h"

namespace toile {

/// An avatar of a scene at a time that can be chosen: what checks and pictures need, without the cloth.
class SceneBody {
public:
    /// Loads the avatar and shows it at t = 0.
    /// @throws InvalidInput for files, clips and bones that do not work.
    explicit SceneBody(const scene::Avatar& settings);

    const scene::Avatar& settings() const { return motion_.settings(); }

    /// True when it never moves.
    bool is_static() const { return motion_.is_static(); }

    /// Shows time t [s]. False when nothing moved since the time shown before.
    bool advance_to(double t);

    /// The solid at the time shown, for avatars given as plane, sphere, capsule or box.
    const Shape* shape() const { return motion_.shape(); }
    const Eigen::Isometry3d& pose() const { return motion_.pose(); } ///< world_from_shape

    /// The surface at the time shown: of a shape a tessellation for pictures.
    const TriangleMesh& surface() const { return surface_; }

    /// What cloth touches of it: all, but for faces of excluded bones (ContactSurface).
    const TriangleMesh& contact_surface() const { return is_all_touched() ? surface_ : contact_; }

    /// The surface's number of a face of the contact surface, -1 where that is a lid over a cut.
    int face_of(int contact_triangle) const
    {
        return is_all_touched() ? contact_triangle : motion_.figure()->face_of(contact_triangle);
    }

private:
    bool is_all_touched() const { return !motion_.figure() || motion_.figure()->is_all_touched(); }
    void place();

    BodyMotion motion_;
    TriangleMesh surface_;
    std::vector<Vec3> start_surface_; ///< [vertices] of a shape, in its own frame [m]
    TriangleMesh contact_;            ///< where that is not all of surface_
};

std::vector<SceneBody> make_bodies(const Scene& scene);

} // namespace toile
