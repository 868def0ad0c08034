#include "core/pd/minimiser/outer_loop.h"

#include <algorithm>
#include <cmath>

#include "core/base/long_work.h"
#include "core/linear/field.h"
#include "core/pd/minimiser/backtrack.h"
#include "core/pd/minimiser/recent_values.h"

namespace toile {

int OuterLoop::max_trials() const { return LineSearch::kMaxTrials; }

OuterLoop::Outcome OuterLoop::minimise(Objective& objective, View<Vec3> x, const Settings& settings)
{
    const StageScope stage("pd/descend");
    for (std::vector<Vec3>* field : {&gradient_, &direction_, &trial_, &trial_gradient_})
        field->resize(x.size());
    begin(x.size());

    Outcome outcome;
    outcome.value = objective.evaluate(x, gradient_);
    objective.accept(x);
    RecentValues recent;
    recent.begin(outcome.value);
    while (std::isfinite(outcome.value) && outcome.iterations < settings.max_iterations) {
        LongWork::iterate(outcome.iterations + 1);
        find_direction(objective, {x, gradient_, trial_gradient_}, direction_);
        outcome.displacement = max_norm(direction_);
        outcome.converged = outcome.displacement <= settings.tolerance &&
                            objective.is_minimiser(gradient_, direction_, settings.tolerance);
        if (outcome.converged && outcome.displacement <= kNegligibleMove * settings.tolerance)
            break;

        // Make the last displacement too. Below the tolerance it is the momentum of small lasting forces,
        // such as friction's. Dropped in every step, these would never act.
        const double step = backtrack(objective, x, outcome.value, gradient_, direction_, trial_,
                                      trial_gradient_, max_trials());
        if (step == 0.0) {
            if (outcome.converged || !fall_back())
                break;
            continue;
        }
        gradient_.swap(trial_gradient_);
        objective.accept(x);
        if (outcome.converged)
            break;
        ++outcome.iterations;
        outcome.displacement *= step;
        outcome.converged =
            recent.add_and_detect_stall(outcome.value, objective.negligible_gain(settings.tolerance));
        if (outcome.converged)
            break;
        update_history({step, direction_, trial_gradient_, gradient_});
    }
    outcome.linear_iterations = linear_iterations();
    outcome.gradient_norm = max_norm(gradient_);
    return outcome;
}

} // namespace toile
