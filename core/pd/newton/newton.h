#pragma once

#include <functional>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/minimiser/outer_loop.h"
#include "core/pd/newton/newton_space.h"

namespace toile {

/// Newton's method on the projected Hessian K of a step [Nocedal & Wright 2006, alg. 7.1]. It folds stiff
/// cloth, where a method around a fixed H gives folding modes the stiffness of the membrane.
///
/// Conjugate gradients solve K d = -g; their coarse matrix is made once per minimisation. Both loops stop by
/// speeds, so an accuracy does not depend on the step length: after a time T the trajectory is within about
/// 2 T tolerance of the converged one.
struct Newton {
    /// Number of setbacks that a minimisation may have: iterations that were moved back, because they would
    /// cross, and kept less than a tenth of their gain. Where nothing can give way, no number is enough:
    /// after kTries steps in succession that ended unfinished there are few, but in every kTries-th step.
    class Patience {
    public:
        int setbacks() const { return unfinished_ < kTries || unfinished_ % kTries == 0 ? kMost : kLeast; }
        void observe(bool converged) { unfinished_ = converged ? 0 : unfinished_ + 1; }

    private:
        static constexpr int kLeast = 3, kMost = 15, kTries = 8;
        int unfinished_ = 0; ///< last steps
    };

    struct Settings {
        /// [m/s] Newton's method stops when the whole Newton step d, not the part that the line search
        /// accepts, is slower: RMS |d| / h < tolerance.
        double tolerance = 0.01;
        int max_iterations = 100;
        double dt = 0.0;                    ///< h [s]
        bool begins_by_local_global = true; ///< while nothing touches
        int max_setbacks = 15;              ///< Patience::setbacks
    };

    /// Looks for contact at the current point between Newton steps. May move it and change the objective.
    /// @return true if it did either
    using Revise = std::function<bool(MinimiserProgress)>;

    /// Minimises from the current point, in place. Begins at rest instead if the value is lower there.
    /// @param revise   may be empty
    /// @param is_calm  nothing touches
    static OuterLoop::Outcome minimise(NewtonSpace& space, const Settings& settings, const Revise& revise,
                                       bool is_calm);
};

} // namespace toile
