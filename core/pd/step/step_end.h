#pragma once

#include <vector>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/step/step_projection.h"

namespace toile {

/// Corrections at the end of a step, for conditions that the minimisation does not guarantee: contact,
/// limits, separation of cloth from cloth.
class StepEnd {
public:
    /// Maximum number of passes, if keep_apart() moves cloth far in each. A walking skirt needs more than
    /// four and at most seven (docs/journal/self_collision.md).
    static constexpr int kPasses = 8;

    /// All are borrowed.
    /// @param x, v    [vertices] positions [m] and velocities [m/s] at t1, modified
    /// @param masses  [vertices] [kg]
    /// @param fixed   [vertices] 1 if the position is prescribed
    StepEnd(View<Vec3> x, View<Vec3> v, View<const double> masses, View<const unsigned char> fixed, double dt)
        : x_(x), v_(v), masses_(masses), fixed_(fixed), dt_(dt)
    {
    }

    /// Satisfies both; either may be null. Cloth that contact moves back stretches against cloth that it does
    /// not move, so the limits are then applied again.
    void satisfy(ActiveSetEnergy* active, StepProjection* projection);

    /// Moves x onto the constraint. The displacement becomes velocity, like that of any force.
    /// @param active  contact to respect meanwhile; may be null
    void project(StepProjection& projection, const ActiveSetEnergy* active);

private:
    View<Vec3> x_, v_;
    View<const double> masses_;
    View<const unsigned char> fixed_;
    double dt_;
    std::vector<double> inverse_masses_;
    std::vector<Vec3> unprojected_;
};

} // namespace toile
