#pragma once

#include <functional>
#include <vector>

#include "core/linear/pcg.h"
#include "core/pd/minimiser/outer_loop.h"
#include "core/pd/preconditioner/affine_space.h"

namespace toile {

/// Newton's method on the projected Hessian K of a step [Nocedal & Wright 2006, alg. 7.1]. It folds stiff
/// cloth, where a method around a fixed H gives folding modes the stiffness of the membrane.
///
/// Conjugate gradients solve K d = -g with the preconditioner
///
///   P = blockdiag(K)^-1 + p K_c^-1 p^T
///
/// of 3 x 3 blocks and an AffineSpace, whose matrix is factored once per step. All of K, its blocks and K_c
/// contain contact. Both loops stop by speeds, so an accuracy does not depend on the step length: after a
/// time T the trajectory is within about 2 T tolerance of the converged one.
class Newton {
public:
    struct Settings {
        /// [m/s] Newton's method stops when the whole Newton step d, not the part that the line search
        /// accepts, is slower: RMS |d| / h < tolerance.
        double tolerance = 0.01;
        int max_iterations = 100;
    };

    /// Looks for contact at x between Newton steps. May move x and change the objective.
    /// @param is_converged  the step was below the tolerance
    /// @return true if it did either
    using Revise = std::function<bool(bool is_converged)>;

    /// @param points  [vertices] undeformed positions, for the clusters of the AffineSpace
    explicit Newton(std::vector<EmbeddedPoint> points) : coarse_(std::move(points)) {}

    /// Declares a new step: the coarse matrix is factored anew in the next minimisation.
    void begin_step() { is_coarse_current_ = false; }

    /// Minimises from x, in place.
    /// @param revise  may be empty
    OuterLoop::Outcome minimise(Objective& objective, View<Vec3> x, const Settings& settings,
                                const Revise& revise);

private:
    struct Direction {
        double speed = 0.0;      ///< [m/s] RMS of the whole step
        bool is_solved = false;  ///< PCG stopped because its increments became small
        int linear_iterations = 0;
    };
    void precondition(Hessian& K);
    Direction find_direction(Objective& objective, Hessian& K, double tolerance);
    double line_search(Objective& objective, View<Vec3> x, double& value);

    AffineSpace coarse_;
    bool is_coarse_current_ = false;
    Pcg pcg_;
    std::vector<Mat3> inverse_blocks_; ///< [vertices] [m/N]
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
};

} // namespace toile
