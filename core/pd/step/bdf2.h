#pragma once

#include "core/compute/types.h"

namespace toile {

/// Time integrators of a body's step.
enum class Integrator { Bdf2, ImplicitEuler };

/// Backward differentiation of second order with a variable step [Hairer & Wanner 1996, V.3]. One solve per
/// step, as implicit Euler, but of second order: a swing keeps its energy. With ratio = h / h_previous,
///
///   x = a0 x_0 - a1 x_{-1} + beta h v,    v = a0 v_0 - a1 v_{-1} + beta h f(x) / m
///
/// A vertex that touches something takes implicit Euler steps while it begins to (a0 = beta = 1, a1 = 0):
/// there BDF2 would rebound.
struct Bdf2 {
    /// Maximum ratio of steps [-]; zero-stable up to 2.41.
    static constexpr double kMaxRatio = 2.0;

    double h = 0.0; ///< [s]
    double beta = 1.0, a0 = 1.0, a1 = 0.0;

    TOILE_HD static Bdf2 implicit_euler(double h) { return {h, 1.0, 1.0, 0.0}; }
    TOILE_HD static Bdf2 of_ratio(double h, double ratio)
    {
        const double scale = 1.0 / (1.0 + 2.0 * ratio);
        return {h, (1.0 + ratio) * scale, (1.0 + ratio) * (1.0 + ratio) * scale, ratio * ratio * scale};
    }

    /// Step length of the implicit Euler step with the same matrix [s].
    TOILE_HD double implicit_step() const { return beta * h; }
};

/// Positions and velocities of the last two steps. [vertices] [m], [m/s]
struct MotionHistory {
    View<const Vec3> x, v, x_previous, v_previous;
};

/// Objective's inertia 1/2 c_i |x_i - y_i|^2 of a step, from motion and external acceleration. Fixed vertices
/// move to their targets.
struct PredictMotion {
    Bdf2 scheme;                       ///< of vertices that do not restart
    MotionHistory history;
    View<const Vec3> acceleration;     ///< [vertices] [m/s^2]
    View<const unsigned char> fixed;   ///< [vertices]
    View<const Vec3> targets;          ///< [vertices] read where fixed [m]
    View<const unsigned char> restart; ///< [vertices] 1: an implicit Euler step
    View<const double> masses;         ///< [vertices] [kg]
    View<Vec3> prediction;             ///< [vertices] out: y [m]
    View<double> inertia;              ///< [vertices] out: c [N/m]

    TOILE_HD void operator()(int i) const
    {
        const Bdf2 s = restart[i] ? Bdf2::implicit_euler(scheme.h) : scheme;
        const double step = s.implicit_step();
        inertia[i] = masses[i] / (step * step);
        if (fixed[i]) {
            prediction[i] = targets[i];
            return;
        }
        const Vec3 velocity = s.a0 * history.v[i] - s.a1 * history.v_previous[i];
        prediction[i] = s.a0 * history.x[i] - s.a1 * history.x_previous[i] +
                        step * (velocity + step * acceleration[i]);
    }
};

/// Velocity at the end of a step.
struct VelocityOfStep {
    Bdf2 scheme;
    View<const Vec3> x_t0, x_previous, x; ///< [vertices] [m]
    View<const unsigned char> restart;    ///< [vertices] 1: an implicit Euler step
    View<Vec3> v;                         ///< [vertices] out [m/s]

    TOILE_HD void operator()(int i) const
    {
        const Bdf2 s = restart[i] ? Bdf2::implicit_euler(scheme.h) : scheme;
        v[i] = (x[i] - s.a0 * x_t0[i] + s.a1 * x_previous[i]) / s.implicit_step();
    }
};

} // namespace toile
