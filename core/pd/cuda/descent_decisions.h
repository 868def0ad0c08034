#pragma once

#include <cmath>
#include <cstddef>

#include "core/pd/cuda/gram_lbfgs.h"
#include "core/pd/minimiser/line_search.h"
#include "core/pd/minimiser/outer_loop.h"
#include "core/pd/step/step_error.h"

namespace toile {

/// Pairs of L-BFGS that a descent stores.
inline constexpr int kHistory = 5;

/// Sums of an evaluation over all vertices.
struct TrialSums {
    static constexpr int kLargest = 2; ///< index of the number that is a maximum

    double value = 0.0;          ///< [J] of the objective at the trial point
    double slope = 0.0;          ///< [J] gradient . direction
    double largest_square = 0.0; ///< [m^2] of the direction's vectors: a maximum, not a sum
    StepError::Sums error;       ///< of gradient and direction; mass and driving are the step's and stay zero
    PairProducts<kHistory> products; ///< products for the trial's step

    TOILE_HD TrialSums& operator+=(const TrialSums& other)
    {
        value += other.value;
        slope += other.slope;
        largest_square = std::fmax(largest_square, other.largest_square);
        error += other.error;
        products += other.products;
        return *this;
    }
};

static_assert(offsetof(TrialSums, largest_square) == TrialSums::kLargest * sizeof(double));

/// OuterLoop with L-BFGS as a GPU runs it. It makes the same decisions from the same numbers on the device,
/// so that evaluations follow each other without the host. An evaluation computes the gradient at a trial
/// point, applies the inverse to it, sums, decides (decide()), and moves on (TakeTrial).
///
/// The inverse is applied before the trial is accepted; most trials are.
struct Descent {
    enum class Action : int {
        Start,   ///< the trial point is the start of the descent
        Take,    ///< the trial becomes the current point and gets a new direction
        Finish,  ///< the trial becomes the current point; the descent is over
        Shorten, ///< shorter step `search.step` along the same direction
        Restart, ///< plain local/global from the current point
        Rest     ///< the current point stays; the descent is over
    };

    // Inputs.
    double tolerance = 0.0; ///< [m]
    StepStop stop = StepStop::Error;
    int max_iterations = 0;
    double dt2 = 0.0;              ///< [s^2]
    double standing_inertia = 0.0; ///< [J] value of the start guess without motion, from inertia alone
    double mass = 0.0;             ///< [kg] of the free vertices
    double driving = 0.0;          ///< StepError::Sums::driving of the step

    // Results; as OuterLoop::Outcome.
    int iterations = 0;
    int evaluations = 0; ///< each with a decision
    bool is_over = false;
    bool converged = false;
    double displacement = 0.0; ///< [m]
    double start_value = 0.0;  ///< [J] at the start point

    // Current evaluation.
    Action action = Action::Start;
    bool is_new_direction = false;
    int trials = 0;     ///< of this direction
    LineSearch search;  ///< its value is the current point's
    int kept_slot = -1; ///< slot where TakeTrial stores the pair of the step; -1: none
    GramLbfgs<kHistory> pairs;

    /// Restarts at the trial point.
    TOILE_HD void begin()
    {
        iterations = evaluations = 0;
        is_over = converged = false;
        displacement = 0.0;
        action = Action::Start;
        pairs.clear();
    }

    /// Decides on the next action from the sums of an evaluation.
    TOILE_HD void decide(const TrialSums& sums)
    {
        if (is_over) {
            action = Action::Rest;
            return;
        }
        ++evaluations;
        if (action == Action::Start) {
            start_here(sums.value);
            return;
        }
        if (is_new_direction) {
            check_direction(sums);
            if (is_over)
                return;
        }
        const bool descends = search.slope < 0.0;
        if (descends && search.accepts(sums.value))
            take(sums);
        else if (descends && ++trials < LineSearch::kMaxTrials)
            shorten(sums.value);
        else
            give_up();
    }

private:
    TOILE_HD void start_here(double value)
    {
        start_value = search.value = value;
        if (!is_finite(value) || max_iterations == 0)
            finish();
        else
            begin_direction(Action::Take);
        kept_slot = -1;
    }

    TOILE_HD void finish()
    {
        action = Action::Finish;
        is_over = true;
    }

    TOILE_HD void begin_direction(Action how)
    {
        action = how;
        is_new_direction = true;
        search.step = 1.0;
        trials = 0;
    }

    TOILE_HD void check_direction(const TrialSums& sums)
    {
        is_new_direction = false;
        search.slope = sums.slope;
        displacement = std::sqrt(sums.largest_square);
        StepError::Sums error = sums.error;
        error.mass = mass;
        error.driving = driving;
        converged = displacement <= tolerance && error.are_within(tolerance, dt2, stop);
        if (converged && displacement <= kNegligibleMove * tolerance) {
            action = Action::Rest;
            is_over = true;
        }
    }

    /// Accepts the trial. The last displacement, below the tolerance, does not count as an iteration.
    TOILE_HD void take(const TrialSums& sums)
    {
        search.value = sums.value;
        kept_slot = -1;
        if (converged) {
            finish();
            return;
        }
        ++iterations;
        displacement *= search.step;
        kept_slot = pairs.add(sums.products);
        if (iterations >= max_iterations) {
            finish();
            return;
        }
        pairs.find_direction();
        begin_direction(Action::Take);
    }

    TOILE_HD void shorten(double trial_value)
    {
        search.shorten(trial_value);
        action = Action::Shorten;
    }

    /// Drops the pairs, which leaves plain local/global; ends if there are none.
    TOILE_HD void give_up()
    {
        if (converged || pairs.count() == 0) {
            action = Action::Rest;
            is_over = true;
            return;
        }
        pairs.clear();
        begin_direction(Action::Restart);
    }
};

} // namespace toile
