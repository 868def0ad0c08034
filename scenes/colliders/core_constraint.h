#pragma once

#include <string>
#include <vector>

#include "scenes/colliders/collider.h"

namespace toile::scenes {

/// The core of a soft body in a running scene: vertices that follow the bones of an avatar, by the skin
/// weights of the surface point nearest to them at the start.
///
///   x(t) = M(t) M(0)^-1 x(0),   M = sum_k w_k [A_k | b_k]      (SkinView::posed)
class CoreConstraint {
public:
    /// @param start      [vertices of the body] [m]
    /// @param colliders  at the start
    /// @param location   named in errors, e.g. "dance.json: soft_bodies[0].core"
    /// @throws InvalidInput for unknown bones, bones that are flat at the start, and a depth that leaves
    /// nothing in the core or outside it
    CoreConstraint(const scene::Core& settings, View<const Vec3> start,
                   const std::vector<Collider>& colliders, const std::string& location);

    const std::vector<int>& vertices() const { return vertices_; } ///< of the body, ascending

    /// True if a vertex moves faster in the colliders' step of dt [s] than surfaces that carry cloth along
    /// (collision::BodySurfaces::kMaxSpeed).
    bool has_jumped(const std::vector<Collider>& colliders, double dt) const;

    /// Advances the targets to the time of the colliders.
    void follow(const std::vector<Collider>& colliders);

    /// Target of the k-th vertex of the core at the time of follow() [m].
    const Vec3& target(int k) const { return targets_[k]; }

private:
    avatars::SkinView skin() const { return {rest_, first_, influences_}; }
    void bind(const Vec3& start, const collision::SurfacePoint& at, const Triangle& corners,
              const SkinnedCollider& body, const std::string& location);

    int collider_;
    std::vector<int> vertices_;
    std::vector<Vec3> rest_; ///< [vertices of the core] see SkinView
    std::vector<int> first_; ///< likewise
    std::vector<avatars::Influence> influences_;
    std::vector<Vec3> targets_; ///< [vertices of the core] [m]
};

} // namespace toile::scenes
