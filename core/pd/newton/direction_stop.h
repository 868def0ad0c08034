#pragma once

#include <algorithm>
#include <cmath>

#include "core/pd/newton/hessian_solver.h"

namespace toile {

/// Stops of the solves of a minimisation, whose errors are speeds: RMS by weight (ComponentWeights), per time
/// of the step. The Hessian is at least the inertia, so that an error in energy bounds that in speed.
class DirectionStop {
public:
    /// @param stiffness  [N/m] of the free vertices' inertia, by components: that of the lightest times their
    ///                   number
    /// @param dt         [s]
    void begin_step(double stiffness, double dt)
    {
        stiffness_ = stiffness;
        dt_ = dt;
    }
    void begin_direction(bool is_first_of_step)
    {
        if (is_first_of_step)
            inverse_ritz_ = 0.0;
    }

    /// @param error  [m/s] that is small enough
    HessianSolver::Stop at(double error) const
    {
        const double moved = error * dt_;
        return {stiffness_ * moved * moved, inverse_ritz_};
    }

    /// Takes a solve, for those that follow.
    void take(const HessianSolver::Outcome& outcome)
    {
        inverse_ritz_ = std::max(inverse_ritz_, outcome.ritz.inverse());
    }

    /// Bound [m/s] on the speed of a field u with an energy u . K u [J].
    double speed(double energy) const
    {
        return stiffness_ > 0.0 ? std::sqrt(energy / stiffness_) / dt_ : 0.0;
    }

private:
    double stiffness_ = 0.0, dt_ = 0.0;
    double inverse_ritz_ = 0.0; ///< largest of the minimisation, see HessianSolver::Stop
};

} // namespace toile
