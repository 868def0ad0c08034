#pragma once

#include <cmath>

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
/// there BDF2 would rebound. So does all of a stiff part, of which none touched anything before: sound passes
/// through it within the step.
struct Bdf2 {
    /// Maximum ratio of steps [-]; zero-stable up to 2.41.
    static constexpr double kMaxRatio = 2.0;

    double h = 0.0; ///< [s]
    double beta = 1.0, a0 = 1.0, a1 = 0.0;
    double ratio = 0.0; ///< [-] 0: implicit Euler

    TOILE_HD static Bdf2 implicit_euler(double h) { return {h, 1.0, 1.0, 0.0, 0.0}; }
    TOILE_HD static Bdf2 of_ratio(double h, double ratio)
    {
        const double scale = 1.0 / (1.0 + 2.0 * ratio);
        return {h, (1.0 + ratio) * scale, (1.0 + ratio) * (1.0 + ratio) * scale, ratio * ratio * scale,
                ratio};
    }

    /// @param previous  length of the last step [s], 0 for none: the matrix is that of equal steps
    TOILE_HD static Bdf2 make(Integrator integrator, double h, double previous)
    {
        if (integrator == Integrator::ImplicitEuler)
            return implicit_euler(h);
        const double ratio = previous > 0.0 ? h / previous : 1.0;
        return of_ratio(h, ratio <= kMaxRatio ? ratio : 1.0);
    }

    /// Step length of the implicit Euler step with the same matrix [s].
    TOILE_HD double implicit_step() const { return beta * h; }

    /// Local error of a step: a fixed part of its distance from a guess by the velocities before, of the same
    /// order (Milne's device).
    /// @param x, v, v_previous  at the start of the step, and one step earlier [m], [m/s]
    TOILE_HD Vec3 error_of(const Vec3& x_t1, const Vec3& x, const Vec3& v, const Vec3& v_previous) const
    {
        if (ratio == 0.0)
            return 0.5 * (x_t1 - x - h * v);
        const Vec3 guess = x + h * ((1.0 + 0.5 * ratio) * v - 0.5 * ratio * v_previous);
        const double own = (1.0 + ratio) * (1.0 + ratio) / (6.0 * ratio * (1.0 + 2.0 * ratio));
        const double of_guess = 1.0 / 6.0 + 1.0 / (4.0 * ratio);
        return own / (own + of_guess) * (x_t1 - guess);
    }
};

/// Sum of the local errors of a step.
struct StepErrorSum {
    double squares = 0.0; ///< [m^2]
    double count = 0.0;   ///< vertices

    TOILE_HD StepErrorSum& operator+=(const StepErrorSum& other)
    {
        squares += other.squares;
        count += other.count;
        return *this;
    }
    TOILE_HD double rms() const { return count > 0.0 ? std::sqrt(squares / count) : 0.0; }
};

/// State of the integrator for kernels: the last two steps, and what touched. [vertices]
struct MotionView {
    View<Vec3> x, v, x_previous, v_previous; ///< [m], [m/s]
    View<unsigned char> restart;             ///< 1: this step is one of implicit Euler
    View<unsigned char> touched, touches;    ///< at the start of the step; now
    View<const unsigned char> fixed;
    View<const int> stiff_part; ///< [vertices] its number, -1: none; empty: there are none
    View<unsigned char> part_touched, part_touches; ///< [stiff parts] any of the vertices

    TOILE_HD Bdf2 scheme_of(int i, const Bdf2& scheme) const
    {
        return restart[i] != 0 || fixed[i] != 0 ? Bdf2::implicit_euler(scheme.h) : scheme;
    }
    TOILE_HD bool has_begun_to_touch(int i) const
    {
        if (touches[i] != 0 && touched[i] == 0)
            return true;
        const int part = stiff_part.empty() ? -1 : stiff_part[i];
        return part >= 0 && part_touches[part] != 0 && part_touched[part] == 0;
    }
};

/// Marks the stiff part of vertex i if it touches something. Threads may write the same value.
struct MarkPart {
    MotionView motion;
    TOILE_HD void operator()(int i) const
    {
        const int part = motion.stiff_part[i];
        if (part >= 0 && motion.touched[i] != 0)
            motion.part_touched[part] = 1;
        if (part >= 0 && motion.touches[i] != 0)
            motion.part_touches[part] = 1;
    }
};

/// Inertia 1/2 c_i |x_i - y_i|^2 of a step, from the motion so far and external acceleration. Fixed vertices
/// move to their targets.
struct PredictMotion {
    Bdf2 scheme;
    MotionView motion;
    View<const Vec3> acceleration; ///< [vertices] [m/s^2]
    View<const Vec3> targets;      ///< [vertices] read where fixed [m]
    View<const double> masses;     ///< [vertices] [kg]
    View<Vec3> prediction;         ///< [vertices] out: y [m]
    View<double> inertia;          ///< [vertices] out: c [N/m]

    TOILE_HD void operator()(int i) const
    {
        const Bdf2 s = motion.scheme_of(i, scheme);
        const double step = s.implicit_step();
        inertia[i] = masses[i] * (1.0 / (step * step));
        if (motion.fixed[i] != 0) {
            prediction[i] = targets[i];
            return;
        }
        const Vec3 velocity = s.a0 * motion.v[i] - s.a1 * motion.v_previous[i];
        prediction[i] =
            s.a0 * motion.x[i] - s.a1 * motion.x_previous[i] + step * (velocity + step * acceleration[i]);
    }
};

/// Restarts vertices that have begun to touch something.
struct RestartTouching {
    MotionView motion;
    TOILE_HD void operator()(int i) const
    {
        if (motion.has_begun_to_touch(i))
            motion.restart[i] = 1;
    }
};

/// Local error of a step that ends at x_t1, of free vertices that nothing has hit.
struct MotionError {
    Bdf2 scheme;
    MotionView motion;
    View<const Vec3> x_t1; ///< [vertices] [m]
    bool is_first;         ///< of the body: every vertex begins its motion

    TOILE_HD StepErrorSum operator()(int i) const
    {
        const bool is_hit = motion.has_begun_to_touch(i) || (motion.restart[i] != 0 && !is_first);
        if (is_hit || motion.fixed[i] != 0)
            return {};
        const Bdf2 s = motion.scheme_of(i, scheme);
        return {s.error_of(x_t1[i], motion.x[i], motion.v[i], motion.v_previous[i]).squaredNorm(), 1.0};
    }
};

/// Velocity at the end of a step. Vertices that have begun to touch took part in an impact.
struct FinishMotion {
    Bdf2 scheme;
    MotionView motion;
    View<const Vec3> x_t1; ///< [vertices] [m]
    bool is_first;         ///< see MotionError

    /// @return MotionError
    TOILE_HD StepErrorSum operator()(int i) const
    {
        const StepErrorSum error = MotionError{scheme, motion, x_t1, is_first}(i);
        RestartTouching{motion}(i);
        const Bdf2 s = motion.scheme_of(i, scheme);
        motion.v_previous[i] = motion.v[i];
        motion.v[i] = (x_t1[i] - s.a0 * motion.x[i] + s.a1 * motion.x_previous[i]) / s.implicit_step();
        return error;
    }
};

/// Makes the end of a step the next start; touches is to be cleared. The next step restarts vertices that
/// have begun to touch, that a constraint has moved from where the minimiser left them, or that may be
/// released.
struct EndMotion {
    MotionView motion;
    View<const Vec3> minimiser, x_t1; ///< [vertices] [m]

    TOILE_HD void operator()(int i) const
    {
        const bool was_moved = x_t1[i] != minimiser[i];
        motion.restart[i] =
            (unsigned char)(motion.has_begun_to_touch(i) || was_moved || motion.fixed[i] != 0);
        motion.touched[i] = motion.touches[i];
        motion.x_previous[i] = motion.x[i];
        motion.x[i] = x_t1[i];
    }
};

} // namespace toile
