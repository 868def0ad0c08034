#pragma once

#include <memory>

#include "collision/colliders.h"
#include "collision/contact.h"
#include "scenes/body_motion.h"

namespace toile {

/// An avatar of a running scene: a body that moves step by step, and its collider.
class Obstacle {
public:
    explicit Obstacle(const scene::Avatar& settings, double default_friction);

    const std::string& name() const { return body_.settings().name; }

    /// The end of the last step becomes the start of this one, which ends at t_t1 [s].
    void advance_to(double t_t1);

    /// True when anything moved in the current step.
    bool moved() const { return moved_; }

    ContactPartner partner() const { return {mesh_collider_.get(), shape_collider_.get()}; }
    double friction() const { return friction_; } ///< [-] with what gives no other
    const BodyMotion& body() const { return body_; }

private:
    BodyMotion body_;
    double friction_;
    bool moved_ = false;
    std::unique_ptr<MeshCollider> mesh_collider_;
    std::unique_ptr<ShapeCollider> shape_collider_;
};

} // namespace toile
