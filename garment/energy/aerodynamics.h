#pragma once

#include <memory>
#include <vector>

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
    struct Settings {
        double density = 1.2;     ///< [kg/m^3] 0 switches the air off
        double normal = 1.0;      ///< [-] drag coefficient of a plate across the flow
        double tangential = 0.05; ///< [-] skin friction along the flow
    };

    Aerodynamics(std::shared_ptr<const RestShape> rest, const Settings& settings);

    /// True when it can act at all; otherwise callers skip the stage.
    bool is_active() const
    {
        return settings_.density > 0.0 && (settings_.normal > 0.0 || settings_.tangential > 0.0);
    }

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
