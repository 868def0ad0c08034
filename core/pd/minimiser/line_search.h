#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile {

/// std::isfinite for the host and kernels.
TOILE_HD inline bool is_finite(double value) { return value - value == 0.0; }

/// Backtracking along a direction [Nocedal & Wright 2006, alg. 3.1], for evaluations on the CPU or on a GPU.
struct LineSearch {
    /// Fraction of the predicted decrease that a step must reach [-] (Armijo).
    static constexpr double kSufficientDecrease = 1e-4;

    /// Rounding error of an objective value relative to its size [-]: smaller differences are not
    /// significant.
    static constexpr double kValueNoise = 1e-14;

    /// Halvings (or stronger cuts) before a direction is given up.
    static constexpr int kMaxTrials = 12;

    double value = 0.0; ///< [J] at the start of the direction
    double slope = 0.0; ///< [J] along it, negative
    double step = 1.0;  ///< [-] next step along the direction

    TOILE_HD bool accepts(double trial_value) const
    {
        return trial_value <= value + kSufficientDecrease * step * slope + kValueNoise * std::fabs(value);
    }

    /// Sets the step to the minimum of the parabola through value, slope and trial value, away from both
    /// ends.
    TOILE_HD void shorten(double trial_value)
    {
        const double excess = trial_value - value - step * slope;
        const double parabola = is_finite(excess) ? -0.5 * slope * step * step / excess : 0.0;
        step = std::fmin(std::fmax(parabola, 0.1 * step), 0.5 * step);
    }
};

} // namespace toile
