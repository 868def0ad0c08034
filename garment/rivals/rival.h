#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/pd/point_masses.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"

namespace toile {

/// What a rival method simulates: the same cloth that a Body gets as energies.
struct ClothModel {
    std::shared_ptr<const RestShape> rest;
    std::vector<double> masses; ///< [vertices] [kg], positive
    Membrane::Settings stretch;
    Bending::Settings bending;
};

/// A whole simulation method by other people, to be measured against Body.
///
/// None of them knows contact. A step with contact moves the cloth first and resolves contact by positions
/// afterwards (ActiveSetEnergy::resolve), as position-based programs do; a StepProjection follows.
class Rival : public PointMassesOnHost {
public:
    Rival(std::vector<Vec3> positions, ClothModel cloth)
        : PointMassesOnHost(std::move(positions)), cloth_(std::move(cloth))
    {
    }

    /// @return iterations, displacement and status; energy and gradient are left 0: evaluating them is no
    ///         part of these methods
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets)
    {
        return step(dt, acceleration, fixed, targets, nullptr, nullptr);
    }

    View<const double> masses() const override { return cloth_.masses; }

protected:
    /// The method itself: x_t1_ and v_ after dt [s] from x_ and v_, which has no contact.
    virtual StepReport advance(double dt, View<const Vec3> acceleration,
                               const std::vector<unsigned char>& fixed, View<const Vec3> targets) = 0;

    ClothModel cloth_;

private:
    void begin_contact(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                       View<const Vec3> targets, ActiveSetEnergy& active);

    std::vector<Vec3> reach_;      ///< [vertices] q*, where contact is looked for [m]
    std::vector<double> diagonal_; ///< [vertices] M / dt^2 [N/m]
};

} // namespace toile
