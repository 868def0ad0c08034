#pragma once

#include <memory>

#include "core/pd/energy.h"
#include "scenes/world.h"

namespace toile::stress {

/// Mechanical energy of a cloth from its positions alone, whatever the solver believes.
class EnergyMeter {
public:
    /// @param gravity  [m/s^2]; potential energy is 0 at the origin's height
    EnergyMeter(const ClothState& cloth, const Vec3& gravity);

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

} // namespace toile::stress
