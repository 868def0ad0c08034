#pragma once

namespace toile {

/// Points of a step's objective that Newton's method visits, on the machine that makes the step: the current
/// point with its gradient, a direction from there, and a trial point with its own.
class NewtonSpace {
public:
    virtual ~NewtonSpace() = default;

    /// Solution of a linear system, by conjugate gradients.
    struct Solution {
        int iterations = 0;
        bool is_solved = false; ///< false: stopped by their limit
        double error = 0.0;     ///< [m/s] estimate of the direction's error, like Trial::speed
        double size = 0.0;      ///< [m/s] likewise of the direction found: a bound on its speed
        double decrease = 0.0;  ///< [J] that the model predicts
    };
    struct Trial {
        double value = 0.0;        ///< [J] of the objective
        double slope = 0.0;        ///< [J] gradient . direction, at the current point
        double end_slope = 0.0;    ///< [J] likewise, with the gradient at the trial point
        double speed = 0.0;        ///< [m/s] RMS of the whole direction by weight, per time of the step
        double displacement = 0.0; ///< [m] largest of the whole direction
    };

    /// Evaluates value [J] and gradient at the current point, which others may have moved.
    virtual double evaluate() = 0;

    /// Bound on the speed of the Newton step from the current point, by its gradient and the inertia [m/s].
    virtual double max_speed() = 0;

    /// Finds the direction d by K d = -g, with the Hessian K at the current point.
    /// @param is_first   of the minimisation
    /// @param error      [m/s] see Solution
    virtual Solution find_direction(bool is_first, double error) = 0;

    // Contact ahead. The direction is d + length e: e is find_direction()'s with d = 0, or correct()'s.

    /// True if there are contact terms.
    virtual bool has_contact() = 0;

    /// Sets the length [-] of e. @return change of the value [J] where everything but contact is quadratic,
    /// and contact what it is at the end of the direction
    virtual double model(double length) = 0;

    /// Takes d + length e as d, and finds e by the contact there.
    virtual Solution correct(double error) = 0;

    // Trial points.

    /// @param length  [-] along the direction
    virtual Trial try_step(double length) = 0;

    /// No motion. @return its value; infinite, without evaluation, if its inertia alone is `limit` [J] or
    /// more
    virtual double try_rest(double limit) = 0;

    /// A local and a global step, x - H^-1 g(x): the best first step while nothing touches.
    virtual double try_local_global() = 0;

    /// Makes the last trial point the current one.
    virtual void take() = 0;

    /// Makes another point along the direction the trial point and the current one, without evaluation. The
    /// direction begins where the current point was before take().
    /// @param length  [-]
    virtual void retake(double length) = 0;

    /// Keeps the current point, and returns to the one that was kept last.
    virtual void keep() = 0;
    virtual void restore() = 0;

    /// True if others have moved the current point since take() or retake(). To be asked before evaluate(),
    /// which may overwrite the trial point.
    virtual bool has_moved() = 0;

    // The step.

    /// RMS speed that external forces alone would add in it [m/s].
    virtual double driving_speed() = 0;

    /// True if a fixed vertex has another target than its position.
    virtual bool are_fixed_moving() = 0;

    /// Largest entry of the gradient at the current point [N].
    virtual double gradient_norm() = 0;
};

} // namespace toile
