#pragma once

#include <cmath>

#include "core/compute/types.h"
#include "core/pd/step/step_stop.h"

namespace toile {

/// Error estimate from the gradient: distance of a point from the step's minimiser, for any method and any
/// approximate inverse. All lengths are root mean squares by mass [m].
///
/// If the energies are convex, M/dt^2 <= Hessian <= H: the error is at least |H^-1 g| and at most
/// |dt^2 M^-1 g|. Soft modes are near one bound, stretch near the other. Their geometric mean follows the
/// true error within a factor of about two over four decades (docs/journal/projective_dynamics.md).
class StepError {
public:
    /// Sums over all vertices.
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

        /// See StepError::is_within().
        TOILE_HD bool are_within(double tolerance, double dt2, StepStop stop) const
        {
            const double min_error = std::sqrt(move), max_error = dt2 * std::sqrt(force);
            return (stop == StepStop::Move || min_error * max_error <= tolerance * tolerance * mass) &&
                   dt2 * std::fabs(opposing) <= kMaxUnbalanced * driving;
        }
    };

    /// Energy between two points at half the tolerance [m] from each other, by inertia alone [J].
    TOILE_HD static double energy_of(double tolerance, double mass, double dt)
    {
        return 0.125 * mass * (tolerance / dt) * (tolerance / dt);
    }

    /// @param masses      [vertices] [kg]
    /// @param fixed       [vertices] 1: excluded
    /// @param start       [vertices] positions at t0 [m]
    /// @param prediction  [vertices] q* [m]
    /// All are borrowed.
    StepError(View<const double> masses, View<const unsigned char> fixed, View<const Vec3> start,
              View<const Vec3> prediction, double dt);

    /// True if the error is at most about the tolerance, and the step has responded to its driving force. A
    /// tiny displacement does not prove convergence while most of the weight is unbalanced.
    /// @param gradient  [vertices] [N]
    /// @param move      [vertices] next displacement of the method [m]
    /// @param stop      Move: skips the error estimate
    bool is_within(double tolerance, View<const Vec3> gradient, View<const Vec3> move, StepStop stop) const;

private:
    /// Fraction [-] of the driving force M (q* - x0) / dt^2 that the gradient may retain.
    static constexpr double kMaxUnbalanced = 0.3;

    Sums sums(View<const Vec3> gradient, View<const Vec3> move) const;

    View<const double> masses_;
    View<const unsigned char> fixed_;
    View<const Vec3> start_, prediction_;
    double dt2_;
};

} // namespace toile
