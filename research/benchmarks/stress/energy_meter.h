#pragma once

#include <memory>

#include "core/pd/energy/energy.h"
#include "scenes/world/world.h"

namespace toile::research::stress {

/// Mechanical energy of a cloth from positions and velocities alone, independent of the solver.
class EnergyMeter {
public:
    /// @param gravity  [m/s^2]; potential energy is 0 at the origin's height
    EnergyMeter(const scenes::ClothState& cloth, const Vec3& gravity);

    /// Kinetic + elastic + potential energy [J].
    /// @param x, v  [vertices] [m], [m/s]
    double measure(View<const Vec3> x, View<const Vec3> v);

    double mass() const { return mass_; } ///< [kg]

private:
    std::vector<double> masses_;
    double mass_ = 0.0;
    Vec3 gravity_;
    std::vector<std::unique_ptr<Energy>> elastic_;
    std::vector<Vec3> unused_gradient_;
};

} // namespace toile::research::stress
