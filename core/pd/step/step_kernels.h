#pragma once

#include "core/compute/types.h"

namespace toile {

/// Position of a vertex at the end of a step under external forces alone: q* = x + dt v + dt^2 a; fixed
/// vertices move to their targets.
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

/// Inertia 1/2 c |x - y|^2 of a vertex.
struct InertiaOfVertex {
    View<const double> inertia;  ///< [vertices] c [N/m]
    View<const Vec3> prediction; ///< [vertices] y [m]
    View<const Vec3> x;          ///< [vertices] [m]
    View<Vec3> gradient;         ///< [vertices] overwritten [N]

    /// @return its energy [J]
    TOILE_HD double operator()(int i) const { return at(i, x[i], prediction[i], inertia[i]); }

    /// Evaluates at values that the caller has loaded.
    TOILE_HD double at(int i, const Vec3& x_i, const Vec3& prediction_i, double inertia_i) const
    {
        const Vec3 away = x_i - prediction_i, force = inertia_i * away;
        gradient[i] = force;
        return 0.5 * force.dot(away);
    }
};

} // namespace toile
