#pragma once

#include <vector>

#include "core/pd/energy/objective.h"

namespace toile {

/// Fraction of the tolerance [-] below which a last displacement is not made.
inline constexpr double kNegligibleMove = 1e-4;

/// Descent shared by all methods of the outer loop: a direction from the method, Armijo backtracking along it
/// [Nocedal & Wright 2006, alg. 3.1], and one stopping criterion. The value never rises.
///
/// A method returns its full displacement. A step of one is then the normal case, and the length of the
/// direction measures the distance of x from the method's limit.
class OuterLoop {
public:
    struct Settings {
        /// [m] Stop when no vertex would move further in an iteration and the objective agrees. That
        /// displacement is still made; it does not count as an iteration. Also stop if RecentValues::kWindow
        /// iterations together have gained less than the objective's negligible_gain().
        double tolerance = 1e-5;
        int max_iterations = 50;
    };
    struct Outcome {
        int iterations = 0;
        int linear_iterations = 0; ///< PCG iterations of Newton's method; 0 for the others
        bool converged = false;
        double displacement = 0.0;  ///< [m] largest displacement of the last iteration
        double speed = 0.0;         ///< [m/s] RMS of the last Newton step per time; 0 for the others
        double gradient_norm = 0.0; ///< [N] largest entry of the gradient at the end
        double value = 0.0;         ///< [J]; not finite if it was not finite at the start
    };

    virtual ~OuterLoop() = default;

    /// Minimises from x, in place. Keeps no state from earlier calls.
    Outcome minimise(Objective& objective, View<Vec3> x, const Settings& settings);

protected:
    /// State of the loop for a method.
    struct Here {
        View<const Vec3> x;        ///< [vertices] the current point [m]
        View<const Vec3> gradient; ///< [vertices] at x [N]
        View<Vec3> scratch;        ///< [vertices] free until find_direction() returns
    };
    /// An accepted step.
    struct Step {
        double length = 0.0;           ///< [-] of the direction
        View<const Vec3> direction;    ///< [vertices] [m]
        View<const Vec3> gradient;     ///< [vertices] before [N]
        View<const Vec3> new_gradient; ///< [vertices] after [N]
    };

    OuterLoop() = default;
    OuterLoop(const OuterLoop&) = default;
    OuterLoop& operator=(const OuterLoop&) = default;
    OuterLoop(OuterLoop&&) = default;
    OuterLoop& operator=(OuterLoop&&) = default;

    /// Drops the state of earlier problems.
    virtual void begin(int vertex_count) = 0;

    /// Computes the method's displacement [m].
    virtual void find_direction(Objective& objective, const Here& here, View<Vec3> direction) = 0;

    /// Called after every accepted step.
    virtual void update_history(const Step&) {}

    /// Called after a direction that does not lower the value. True if the method has dropped state and has
    /// another direction from the same point.
    virtual bool fall_back() { return false; }

    /// Step lengths to try before a direction is given up.
    virtual int max_trials() const;

    virtual int linear_iterations() const { return 0; } ///< since begin()

private:
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
};

} // namespace toile
