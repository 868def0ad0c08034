#pragma once

#include <functional>
#include <vector>

#include "core/pd/minimiser/outer_loop.h"
#include "core/pd/newton/hessian_solver.h"

namespace toile {

/// Newton's method on the projected Hessian K of a step [Nocedal & Wright 2006, alg. 7.1]. It folds stiff
/// cloth, where a method around a fixed H gives folding modes the stiffness of the membrane.
///
/// HessianSolver solves K d = -g; its coarse matrix is factored once per step. Both loops stop by speeds, so
/// an accuracy does not depend on the step length: after a time T the trajectory is within about
/// 2 T tolerance of the converged one.
class Newton {
public:
    struct Settings {
        /// [m/s] Newton's method stops when the whole Newton step d, not the part that the line search
        /// accepts, is slower: RMS |d| / h < tolerance.
        double tolerance = 0.01;
        int max_iterations = 100;
        double dt = 0.0;     ///< h [s]
        int small_steps = 1; ///< that slow, in succession, after which it has converged
    };

    /// Looks for contact at x between Newton steps. May move x and change the objective.
    /// @param is_converged  the step was below the tolerance
    /// @return true if it did either
    using Revise = std::function<bool(bool is_converged)>;

    /// @param points  [vertices] undeformed positions, for the clusters of the AffineSpace
    explicit Newton(std::vector<EmbeddedPoint> points) : solver_(std::move(points)) {}

    /// Minimises from x, in place.
    /// @param masses  [vertices] [kg]
    /// @param revise  may be empty
    OuterLoop::Outcome minimise(Objective& objective, View<Vec3> x, View<const double> masses,
                                const Settings& settings, const Revise& revise);

private:
    double iterate(Objective& objective, View<Vec3> x, View<const double> masses, const Settings& settings,
                   OuterLoop::Outcome& outcome);

    HessianSolver solver_;
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
};

} // namespace toile
