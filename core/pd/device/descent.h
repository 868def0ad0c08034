#pragma once

#include <cmath>
#include <cstddef>

#include "core/pd/device/gram_lbfgs.h"
#include "core/pd/line_search.h"
#include "core/pd/outer_loop.h"
#include "core/pd/step_error.h"

namespace toile {

/// Pairs of L-BFGS that a descent keeps.
inline constexpr int kHistory = 5;

/// What a turn of the descent sums up over all vertices.
struct TrialSums {
    static constexpr int kLargest = 2; ///< of the numbers, the one that is a maximum

    double value = 0.0;          ///< [J] of the objective at the trial point
    double slope = 0.0;          ///< [J] gradient . direction
    double largest_square = 0.0; ///< [m^2] of the direction's vectors: a maximum, not a sum
    StepError::Sums error;       ///< of gradient and direction; mass and driving are the step's and stay zero
    PairProducts<kHistory> products; ///< of the step that the trial would be

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

/// OuterLoop with L-BFGS as a GPU runs it: the same decisions from the same numbers, made on the device, so
/// that turns can follow each other without the host. A turn evaluates a trial point and the inverse applied
/// to its gradient, sums up, decides (decide()), and moves on (TakeTrial).
///
/// The inverse is applied before it is known whether the trial will be taken, as most are.
struct Descent {
    enum class Action : int {
        Start,   ///< the trial point is where the descent begins
        Take,    ///< the trial becomes the current point, and a direction is found from there
        Finish,  ///< the trial becomes the current point; the descent is over
        Shorten, ///< the same direction, `search.step` of it
        Restart, ///< plain local/global from the current point
        Rest     ///< the current point stays; the descent is over
    };

    // What is asked.
    double tolerance = 0.0; ///< [m]
    StepStop stop = StepStop::Error;
    int max_iterations = 0;
    double dt2 = 0.0;     ///< [s^2]
    double mass = 0.0;    ///< [kg] of the free vertices
    double driving = 0.0; ///< StepError::Sums::driving of the step

    // What has come of it; as OuterLoop::Outcome.
    int iterations = 0;
    int turns = 0; ///< of evaluating and deciding that it took
    bool is_over = false;
    bool converged = false;
    double displacement = 0.0; ///< [m]
    double start_value = 0.0;  ///< [J] where it began

    // The turn.
    Action action = Action::Start;
    bool is_new_direction = false;
    int trials = 0;     ///< of this direction
    LineSearch search;  ///< its value is the current point's
    int kept_slot = -1; ///< where TakeTrial puts the pair of the step; -1: nowhere
    GramLbfgs<kHistory> pairs;

    /// Begins anew at the trial point.
    TOILE_HD void begin()
    {
        iterations = turns = 0;
        is_over = converged = false;
        displacement = 0.0;
        action = Action::Start;
        pairs.clear();
    }

    /// Looks at the sums of a turn and says what comes next.
    TOILE_HD void decide(const TrialSums& sums)
    {
        if (is_over) {
            action = Action::Rest;
            return;
        }
        ++turns;
        if (action == Action::Start) {
            start_here(sums.value);
            return;
        }
        if (is_new_direction) {
            look_at_direction(sums);
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
            turn_to_new_direction(Action::Take);
        kept_slot = -1;
    }

    TOILE_HD void finish()
    {
        action = Action::Finish;
        is_over = true;
    }

    TOILE_HD void turn_to_new_direction(Action how)
    {
        action = how;
        is_new_direction = true;
        search.step = 1.0;
        trials = 0;
    }

    TOILE_HD void look_at_direction(const TrialSums& sums)
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

    /// The last move of all, below the tolerance, does not count as an iteration.
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
        turn_to_new_direction(Action::Take);
    }

    TOILE_HD void shorten(double trial_value)
    {
        search.shorten(trial_value);
        action = Action::Shorten;
    }

    /// Without its pairs the method is plain local/global; where that leads nowhere it ends.
    TOILE_HD void give_up()
    {
        if (converged || pairs.count() == 0) {
            action = Action::Rest;
            is_over = true;
            return;
        }
        pairs.clear();
        turn_to_new_direction(Action::Restart);
    }
};

} // namespace toile
