#pragma once

#include <cmath>

#include "core/backend/types.h"
#include "core/pd/step_stop.h"

namespace toile {

/// Tells from the gradient how far a point of a step is from the step's minimiser, whatever method and
/// whatever approximate inverse have led there. All lengths are root mean squares by mass [m].
///
/// Where the energies are convex, M/dt^2 <= Hessian <= H: the error is at least the move -H^-1 g, and at most
/// dt^2 M^-1 g. Soft modes are near one end, stretch near the other; the geometric mean of the two follows
/// the true error within a factor of two or so over four decades (docs/core/pd.md).
class StepError {
public:
    /// What it takes of all vertices.
    struct Sums {
        double mass = 0.0;     ///< [kg]
        double move = 0.0;     ///< |move|^2_M
        double force = 0.0;    ///< |M^-1 g|^2_M
        double driving = 0.0;  ///< |q* - x0|^2_M
        double opposing = 0.0; ///< g . (q* - x0)

        TOILE_HD Sums& operator+=(const Sums& other)
        {
            mass += other.mass;
            move += other.move;
            force += other.force;
            driving += other.driving;
            opposing += other.opposing;
            return *this;
        }

        /// StepError::is_within().
        TOILE_HD bool are_within(double tolerance, double dt2, StepStop stop) const
        {
            const double least = std::sqrt(move), most = dt2 * std::sqrt(force);
            return (stop == StepStop::Move || least * most <= tolerance * tolerance * mass) &&
                   dt2 * std::fabs(opposing) <= kMostUnanswered * driving;
        }
    };

    /// Energy that tells two points apart whose distance is half the tolerance [m] [J]: what inertia alone
    /// makes of it.
    TOILE_HD static double energy_of(double tolerance, double mass, double dt)
    {
        return 0.125 * mass * (tolerance / dt) * (tolerance / dt);
    }

    /// @param masses      [vertices] [kg]
    /// @param fixed       [vertices] 1: left out
    /// @param start       [vertices] positions at t0 [m]
    /// @param prediction  [vertices] q* [m]
    /// All are borrowed.
    StepError(View<const double> masses, View<const unsigned char> fixed, View<const Vec3> start,
              View<const Vec3> prediction, double dt);

    /// True when the error is about the tolerance or less, and the step has answered what drives it: a move
    /// too small to see is no sign of rest while most of the weight hangs in the air.
    /// @param gradient  [vertices] [N]
    /// @param move      [vertices] that the method wants next [m]
    /// @param stop      Move: of the error, only that
    bool is_within(double tolerance, View<const Vec3> gradient, View<const Vec3> move, StepStop stop) const;

private:
    /// Share [-] of what drives a step, M (q* - x0) / dt^2, that may be left in the gradient.
    static constexpr double kMostUnanswered = 0.3;

    Sums sums(View<const Vec3> gradient, View<const Vec3> move) const;

    View<const double> masses_;
    View<const unsigned char> fixed_;
    View<const Vec3> start_, prediction_;
    double dt2_;
};

} // namespace toile
