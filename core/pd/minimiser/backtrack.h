#pragma once

#include <algorithm>
#include <vector>

#include "core/linear/field.h"
#include "core/pd/energy/objective.h"
#include "core/pd/minimiser/line_search.h"

namespace toile {

/// Backtracks along a direction from x until the value decreases sufficiently; x and value move on success.
/// @param gradient         [vertices] at x [N]
/// @param trial            [vertices] out: the last point that was tried, x on success [m]
/// @param trial_gradient   [vertices] out: there [N]
/// @return the accepted step length, 0 if there is none
inline double backtrack(Objective& objective, View<Vec3> x, double& value, View<const Vec3> gradient,
                        View<const Vec3> direction, View<Vec3> trial, View<Vec3> trial_gradient,
                        int max_trials)
{
    LineSearch search{value, dot(gradient, direction)};
    if (!(search.slope < 0.0))
        return 0.0;
    for (int attempt = 0; attempt < max_trials; ++attempt) {
        parallel_for(
            kCpu, "outer/trial", x.size(), [&](int i) { trial[i] = x[i] + search.step * direction[i]; },
            kFieldGrain);
        const double trial_value = objective.evaluate(trial, trial_gradient);
        if (search.accepts(trial_value)) {
            std::copy(trial.begin(), trial.end(), x.begin());
            value = trial_value;
            return search.step;
        }
        search.shorten(trial_value);
    }
    return 0.0;
}

} // namespace toile
