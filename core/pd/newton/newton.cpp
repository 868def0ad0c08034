#include "core/pd/newton/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/linear/field.h"
#include "core/pd/minimiser/backtrack.h"

namespace toile {

namespace {

/// Conjugate gradients stop when the RMS of their increment is below this fraction of the tolerance [-],
/// twice in succession. With a fixed number of iterations several times the last step would remain.
constexpr double kIncrement = 0.1;

/// Bound on the Newton step, relative to the tolerance [-], below which no step is made. A larger step
/// is made although it is small: unbalanced forces that no step follows would never come to balance.
constexpr double kNegligible = 0.03;

/// Iterations without a lower value after which the minimisation ends. Cloth that is moved back because it
/// would cross, where contact does not hold it, is pushed there again by the next step.
constexpr int kStall = 8;

} // namespace

OuterLoop::Outcome Newton::minimise(Objective& objective, View<Vec3> x, View<const double> masses,
                                    const Settings& settings, const Revise& revise)
{
    const StageScope stage("pd/newton");
    for (std::vector<Vec3>* field : {&gradient_, &direction_, &trial_, &trial_gradient_})
        field->resize(x.size());
    OuterLoop::Outcome outcome;
    outcome.value = objective.evaluate(x, gradient_);
    double lowest = std::numeric_limits<double>::infinity();
    int since_lowest = 0, small = 0;
    for (int look = 0; std::isfinite(outcome.value) && look < settings.max_iterations; ++look) {
        since_lowest = outcome.value < lowest ? 0 : since_lowest + 1;
        lowest = std::min(lowest, outcome.value);
        if (since_lowest > kStall)
            break;

        double step = 0.0;
        outcome.speed = objective.max_speed_of(gradient_);
        outcome.converged = outcome.speed <= kNegligible * settings.tolerance;
        if (!outcome.converged) {
            step = iterate(objective, x, masses, settings, outcome);
            small = outcome.converged ? small + 1 : 0;
            outcome.converged = outcome.converged && (small >= settings.small_steps || step == 0.0);
        }
        const bool has_changed = revise && revise(outcome.converged);
        if (!has_changed && (outcome.converged || step == 0.0))
            break;
        outcome.converged = false;
        if (has_changed) {
            lowest = std::numeric_limits<double>::infinity();
            small = 0;
        }
        // Cloth may have been moved back by less than counts as a change: stiff terms feel that too.
        const bool has_moved = step > 0.0 && !std::equal(x.begin(), x.end(), trial_.begin());
        if (has_changed || has_moved || step == 0.0)
            outcome.value = objective.evaluate(x, gradient_);
    }
    outcome.gradient_norm = max_norm(gradient_);
    return outcome;
}

/// Makes a Newton step.
/// @return the accepted part of it, 0 if there is none
double Newton::iterate(Objective& objective, View<Vec3> x, View<const double> masses,
                       const Settings& settings, OuterLoop::Outcome& outcome)
{
    objective.accept(x);
    Hessian* const K = objective.hessian();
    if (K == nullptr)
        throw InvalidInput("newton: the objective has no second derivatives; choose another method");
    K->linearise(x, Definiteness::Projected);
    solver_.update(K->parts(), outcome.iterations == 0);
    const HessianSolver::Outcome solve =
        solver_.solve(gradient_, masses, kIncrement * settings.tolerance * settings.dt, direction_);
    const double step = backtrack(objective, x, outcome.value, gradient_, direction_, trial_, trial_gradient_,
                                  LineSearch::kMaxTrials);
    if (step > 0.0)
        gradient_.swap(trial_gradient_);
    ++outcome.iterations;
    outcome.linear_iterations += solve.iterations;
    outcome.speed = objective.speed_of(direction_);
    outcome.displacement = step * max_norm(direction_);
    outcome.converged = solve.is_solved && outcome.speed <= settings.tolerance;
    return step;
}

} // namespace toile
