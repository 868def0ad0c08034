#pragma once

#include "core/backend/types.h"

namespace toile {

/// Where a vertex would be at the end of a step if it were alone: q* = x + dt v + dt^2 a; fixed vertices go
/// to their targets.
struct PredictVertex {
    View<const Vec3> x, v, acceleration; ///< [vertices] [m], [m/s], [m/s^2]
    View<const unsigned char> fixed;     ///< [vertices]
    View<const Vec3> targets;            ///< [vertices] read where fixed [m]
    double dt;
    View<Vec3> prediction; ///< [vertices] out [m]

    TOILE_HD void operator()(int i) const
    {
        prediction[i] = fixed[i] ? targets[i] : Vec3(x[i] + dt * (v[i] + dt * acceleration[i]));
    }
};

/// Inertia 1/(2 dt^2) |x - q*|^2_M of a vertex.
struct InertiaOfVertex {
    View<const double> masses;   ///< [vertices] [kg]
    View<const Vec3> prediction; ///< [vertices] [m]
    double inverse_dt2;          ///< [1/s^2]
    View<const Vec3> x;          ///< [vertices] [m]
    View<Vec3> gradient;         ///< [vertices] overwritten [N]

    /// @return its energy [J]
    TOILE_HD double operator()(int i) const { return at(i, x[i], prediction[i], masses[i]); }

    /// The same of numbers that are at hand.
    TOILE_HD double at(int i, const Vec3& own_x, const Vec3& own_prediction, double mass) const
    {
        const Vec3 away = own_x - own_prediction, force = mass * inverse_dt2 * away;
        gradient[i] = force;
        return 0.5 * force.dot(away);
    }
};

} // namespace toile
