#pragma once

#include <memory>
#include <vector>

#include "garment/energy/air/aerodynamics_kernels.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Wind and air drag on cloth.
///
/// Each triangle moves through the air with u = wind - (mean velocity of its corners). Its force is
///
///   f = 1/2 rho A ( c_n |u_n| u_n + c_t |u_t| u_t )
///
/// split along its normal and in its plane, with velocities at the start of the step. The force at each
/// vertex is limited to what accelerates the vertex to the air's velocity within the step. Therefore no wind
/// and no light fabric makes it unstable. Implicit integration of the drag alone would do that too. It would
/// weaken drag on cloth that resists the wind, since its elastic forces are not part of that equation.
class Aerodynamics {
public:
    using Settings = AirSettings;

    Aerodynamics(std::shared_ptr<const RestShape> rest, const Settings& settings);

    /// True if the air can act at all; otherwise callers skip the stage.
    bool is_active() const { return settings_.is_active(); }

    /// Pressure on cloth at rest across a wind of that speed [m/s], in Pa.
    double pressure(double wind_speed) const
    {
        return 0.5 * settings_.density * settings_.normal * wind_speed * wind_speed;
    }

    /// Adds the acceleration over a step of dt [s] to acceleration [vertices] [m/s^2].
    /// @param wind   mean velocity of the air [m/s]
    /// @param gusts  [vertices] deviation from it (see gusts.h) [m/s]; empty in steady wind
    void add_acceleration(View<const Vec3> x, View<const Vec3> v, View<const double> masses, const Vec3& wind,
                          double dt, View<Vec3> acceleration, View<const Vec3> gusts = {});

private:
    std::shared_ptr<const RestShape> rest_;
    Settings settings_;
    std::vector<Mat3> drag_; ///< [triangles] force per relative velocity for one corner [N s/m]
};

} // namespace toile::garment
