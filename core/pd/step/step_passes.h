#pragma once

#include <algorithm>

#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Sequence of the minimisations of a step. Each begins at the end of the previous one, after contact has
/// updated its candidates. With contact the first ones are cut short. Their result suffices to find the
/// contacts, and further iterations before that would be wasted.
class StepPasses {
public:
    /// Number of minimisations that are cut short, and their limit of iterations.
    static constexpr int kShortPasses = 2, kShortIterations = 6;

    /// @param max_iterations  of a minimisation
    /// @param max_passes      minimisations besides the two short ones; without contact those two are full
    ///                        ones
    StepPasses(int max_iterations, int max_passes)
        : max_iterations_(max_iterations), max_passes_(max_passes + kShortPasses)
    {
    }

    /// Iteration limit of the next minimisation.
    int next(bool in_contact)
    {
        is_short_ = in_contact && pass_ < kShortPasses;
        limit_ = is_short_ ? std::min(kShortIterations, max_iterations_) : max_iterations_;
        return limit_;
    }
    bool is_first() const { return pass_ == 0; }

    /// False if the limit has cut it short.
    bool is_converged(const OuterLoop::Outcome& outcome) const
    {
        return outcome.converged || outcome.iterations < limit_;
    }

    /// @param has_changed  the objective has changed by the result
    /// @return true if another minimisation follows
    bool goes_on(const OuterLoop::Outcome& outcome, bool has_changed)
    {
        ++pass_;
        return pass_ < max_passes_ && (has_changed || (is_short_ && !is_converged(outcome)));
    }

private:
    int max_iterations_, max_passes_, pass_ = 0, limit_ = 0;
    bool is_short_ = false;
};

} // namespace toile
