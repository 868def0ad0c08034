#pragma once

#include <string>
#include <vector>

#include "scenes/colliders/body_motion.h"

namespace toile::scenes {

/// An avatar of a scene at any time, without the cloth: for checks and pictures.
class SceneBody {
public:
    /// Loads the avatar and poses it at t = 0.
    /// @throws InvalidInput for files, clips and bones that do not work.
    explicit SceneBody(const scene::Avatar& settings);

    const scene::Avatar& settings() const { return motion_.settings(); }

    /// True if it never moves.
    bool is_static() const { return motion_.is_static(); }

    /// Poses the avatar at time t [s]. False if nothing has moved since the previous pose.
    bool advance_to(double t);

    /// Shape at the current time, for avatars given as plane, sphere, capsule or box; else null.
    const collision::Shape* shape() const { return motion_.shape(); }
    const Eigen::Isometry3d& pose() const { return motion_.pose(); } ///< world_from_shape

    /// Surface at the current time; for a shape a tessellation for pictures.
    const TriangleMesh& surface() const { return surface_; }

    /// Part of the surface that cloth collides with: all but faces of excluded bones (ContactSurface).
    const TriangleMesh& contact_surface() const { return is_all_collidable() ? surface_ : contact_; }

    /// Index in surface() of a face of the contact surface, -1 for a lid over a cut.
    int face_of(int contact_triangle) const
    {
        return is_all_collidable() ? contact_triangle : motion_.skinned()->face_of(contact_triangle);
    }

    /// Name of the bone that the first corner of a face of surface() follows; empty for -1 and for bodies
    /// without bones.
    std::string bone_of(int face) const;

private:
    bool is_all_collidable() const { return !motion_.skinned() || motion_.skinned()->is_all_collidable(); }
    void place();

    BodyMotion motion_;
    TriangleMesh surface_;
    std::vector<Vec3> start_surface_; ///< [vertices] of a shape, in its local frame [m]
    TriangleMesh contact_;            ///< if not all of surface_
};

/// Avatars of a scene but those that a soft body replaces.
std::vector<SceneBody> make_bodies(const Scene& scene);

} // namespace toile::scenes
