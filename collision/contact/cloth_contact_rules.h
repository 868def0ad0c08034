#pragma once

#include <vector>

#include "collision/ccd/collision_free_step.h"
#include "collision/ccd/rigid_trajectories.h"
#include "collision/contact/cloth_contact_kernels.h"
#include "collision/contact/contact_cloth.h"

namespace toile::collision {

/// Lengths that ClothContact derives from the cloths, the same on CPU and GPU.
class ClothContactRules {
public:
    /// See make_cloth_contact. Thickness is at most half of an altitude, or a fine mesh would push itself
    /// apart; rigid bodies cannot.
    /// @param is_open  [vertices of bodies] that follow those of the cloths; 1: they have no inside
    ClothContactRules(View<const Triangle> triangles, View<const Vec3> positions,
                      const std::vector<ContactCloth>& cloths, View<const double> altitude,
                      View<const unsigned char> is_open = {});

    PairThickness thickness() const { return {half_thickness_}; }
    double thickest() const { return thickest_; } ///< [m] maximum of a pair

    SlackBounds slack() const;
    /// Of the slack for the next step. @param is_clear  no pairs were found in this one
    SlackBounds learned_slack(bool is_clear) const;

    double ignored_correction() const; ///< [m] correction up to which pairs are not searched for again
    double slid() const;               ///< [m] allowed deviation of a pressing pair

    const CollisionFreeStep::Settings& collision_free_step() const { return collision_free_step_; }
    const RigidTrajectories& bodies() const { return bodies_; }

private:
    double edge_; ///< [m] mean edge
    double thickest_ = 0.0;
    std::vector<double> half_thickness_; ///< [vertices] [m]
    CollisionFreeStep::Settings collision_free_step_;
    RigidTrajectories bodies_;
};

} // namespace toile::collision
