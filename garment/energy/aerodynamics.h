#pragma once

#include <memory>
#include <vector>

#include "garment/energy/aerodynamics_kernels.h"
#include "garment/energy/rest_shape.h"

namespace toile {

/// Wind and air drag on cloth.
///
/// Each triangle moves through the air with u = wind - (mean velocity of its corners) and feels
///
///   f = 1/2 rho A ( c_n |u_n| u_n + c_t |u_t| u_t )
///
/// split along its normal and in its plane, with velocities at the start of the step. Vertex by vertex the
/// force is limited to what brings the vertex to the air's velocity within the step, so no wind and no light
/// fabric makes it unstable. Integrating it implicitly by itself would do that too, but would weaken it on
/// cloth that is held against the wind: the elastic forces that hold it are not part of that equation.
class Aerodynamics {
public:
    using Settings = AirSettings;

    Aerodynamics(std::shared_ptr<const RestShape> rest, const Settings& settings);

    /// True when it can act at all; otherwise callers skip the stage.
    bool is_active() const { return settings_.is_active(); }

    /// Adds the acceleration over a step of dt [s] to acceleration [vertices] [m/s^2].
    /// @param wind   mean velocity of the air [m/s]
    /// @param gusts  [vertices] deviation from it (see gusts.h) [m/s]; empty in steady wind
    void add_acceleration(View<const Vec3> x, View<const Vec3> v, View<const double> masses, const Vec3& wind,
                          double dt, View<Vec3> acceleration, View<const Vec3> gusts = {});

private:
    std::shared_ptr<const RestShape> rest_;
    Settings settings_;
    std::vector<Mat3> drag_; ///< [triangles] force per relative velocity, a corner's share [N s/m]
};

} // namespace toile
