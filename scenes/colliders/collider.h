#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/body/colliders.h"
#include "scenes/colliders/body_motion.h"

namespace toile::scenes {

/// An avatar of a running scene: its motion from step to step and its contact collider. A box is a mesh: what
/// holds cloth at the corners of a mesh holds it at its corners too.
class Collider {
public:
    explicit Collider(const scene::Avatar& settings, double default_friction);

    const std::string& name() const { return body_.settings().name; }

    /// Advances to the step that starts at the end of the last one and ends at t_t1 [s].
    void advance_to(double t_t1);

    /// See BodyMotion.
    double motion_to(double t) { return body_.motion_to(t); }

    /// True if anything moved in the current step.
    bool moved() const { return moved_; }

    collision::ContactCollider contact_collider() const
    {
        return {mesh_collider_.get(), shape_collider_.get()};
    }
    double friction() const
    {
        return friction_;
    } ///< [-] default, for cloths and solids without a coefficient for it
    const BodyMotion& body() const { return body_; }

    /// Point of the surface nearest to x at the end of the current step.
    struct SurfacePoint {
        Vec3 point, normal;
        double signed_distance; ///< [m] from the surface to x, negative inside
    };
    SurfacePoint closest(const Vec3& x) const;

private:
    MovingMesh sides(const Eigen::Isometry3d& pose_t0) const;

    BodyMotion body_;
    double friction_;
    bool moved_ = false;
    TriangleMesh box_; ///< sides of a box, in its own frame [m]; empty for others
    std::unique_ptr<collision::MeshCollider> mesh_collider_;
    std::unique_ptr<collision::ShapeCollider> shape_collider_;
};

/// Index of the collider of this name, -1 if there is none.
int index_of(const std::vector<Collider>& colliders, const std::string& name);

} // namespace toile::scenes
