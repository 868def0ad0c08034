#pragma once

#include <utility>
#include <vector>

#include "core/pd/step/point_masses.h"
#include "garment/energy/cloth_model.h"

namespace toile::research {

/// A complete simulation method of the literature, for comparison with Body.
///
/// These methods have no contact. A step with contact moves the cloth first and resolves contact by positions
/// afterwards (ActiveSetEnergy::resolve), as position-based programs do. A StepProjection follows.
class BaselineMethod : public PointMassesOnHost {
public:
    BaselineMethod(std::vector<Vec3> positions, garment::ClothModel cloth)
        : PointMassesOnHost(std::move(positions)), cloth_(std::move(cloth))
    {
    }

    /// @return iterations, displacement and status; energy and gradient remain 0, since these methods do not
    ///         evaluate them
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets)
    {
        return step(dt, acceleration, fixed, targets, nullptr, nullptr);
    }

    View<const double> masses() const override { return cloth_.masses; }

protected:
    /// Advances x_ and v_ by dt [s] without contact, into x_t1_ and v_.
    virtual StepReport advance(double dt, View<const Vec3> acceleration,
                               const std::vector<unsigned char>& fixed, View<const Vec3> targets) = 0;

    garment::ClothModel cloth_;

private:
    void begin_contact(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                       View<const Vec3> targets, ActiveSetEnergy& active);
    void project(double dt, View<const unsigned char> fixed, const ActiveSetEnergy* active,
                 StepProjection& projection);

    std::vector<Vec3> reach_;      ///< [vertices] q*, end of the contact query [m]
    std::vector<double> diagonal_; ///< [vertices] M / dt^2 [N/m]
};

} // namespace toile::research
