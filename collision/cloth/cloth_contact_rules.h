#pragma once

#include <vector>

#include "collision/cloth/cloth_contact_kernels.h"
#include "collision/cloth/rigid_ways.h"
#include "collision/cloth/safe_step.h"
#include "collision/contact_cloth.h"

namespace toile {

/// What ClothContact goes by, wherever it runs: lengths that follow from the cloths.
class ClothContactRules {
public:
    /// See make_cloth_contact. No more than half of an altitude is kept, or a fine mesh would push itself
    /// apart; rigid ones can't.
    ClothContactRules(View<const Triangle> triangles, View<const Vec3> positions,
                      const std::vector<ContactCloth>& cloths, View<const double> altitude);

    PairThickness thickness() const { return {half_thickness_}; }
    double thickest() const { return thickest_; } ///< [m] of the cloths

    SlackBounds slack() const;

    double held_aside() const; ///< [m] that cloth is held back by and not looked at again
    double slid() const;       ///< [m] that a pair which presses may stray

    const SafeStep::Settings& safe_step() const { return safe_step_; }
    const RigidWays& bodies() const { return bodies_; }

private:
    double edge_; ///< [m] mean
    double thickest_ = 0.0;
    std::vector<double> half_thickness_; ///< [vertices] [m]
    SafeStep::Settings safe_step_;
    RigidWays bodies_;
};

} // namespace toile
