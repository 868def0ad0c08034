#pragma once

#include <vector>

#include "core/pd/active_set_energy.h"
#include "core/pd/step_projection.h"

namespace toile {

/// The end of a step in the making, and what a minimisation does not promise of it: surfaces, limits, cloth
/// apart from cloth.
class StepEnd {
public:
    /// How often the end of a step is satisfied at most, where cloth is brought back far again and again. A
    /// walking skirt asks for more than four and at most seven (docs/collision/cloth.md).
    static constexpr int kRounds = 8;

    /// All are borrowed.
    /// @param x, v    [vertices] positions [m] and velocities [m/s] at t1, to be changed
    /// @param masses  [vertices] [kg]
    /// @param fixed   [vertices] 1 where the position is prescribed
    StepEnd(View<Vec3> x, View<Vec3> v, View<const double> masses, View<const unsigned char> fixed, double dt)
        : x_(x), v_(v), masses_(masses), fixed_(fixed), dt_(dt)
    {
    }

    /// Satisfies both; either may be null. Cloth that contact brings back is torn from what it does not bring
    /// back, so limits draw it on from there.
    void satisfy(ActiveSetEnergy* active, StepProjection* projection);

    /// Moves x onto the constraint. What that moves becomes velocity: it is a force like any other.
    /// @param active  respected on the way; may be null
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
