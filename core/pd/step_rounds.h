#pragma once

#include <algorithm>

#include "core/pd/outer_loop.h"

namespace toile {

/// How the minimisations of a step follow each other. Each begins where the last has ended, with what contact
/// has then looked at anew. The first ones are cut short where something touches: what they find is near
/// enough to see what will touch what, and what is minimised before that is known is for nothing.
class StepRounds {
public:
    /// Minimisations that are looks, and the iterations they are cut short at.
    static constexpr int kLooks = 2, kIterationsOfLook = 6;

    /// @param max_iterations  of a minimisation
    /// @param max_rounds      minimisations besides two looks, which are whole ones where nothing touches
    StepRounds(int max_iterations, int max_rounds)
        : max_iterations_(max_iterations), max_rounds_(max_rounds + kLooks)
    {
    }

    /// Limit of the next minimisation.
    int next(bool touches)
    {
        is_look_ = touches && round_ < kLooks;
        limit_ = is_look_ ? std::min(kIterationsOfLook, max_iterations_) : max_iterations_;
        return limit_;
    }
    bool is_first() const { return round_ == 0; }

    /// False where the limit has cut it short.
    bool is_settled(const OuterLoop::Outcome& outcome) const
    {
        return outcome.converged || outcome.iterations < limit_;
    }

    /// @param has_changed  what is minimised, by how it ended
    /// @return true where another minimisation is to follow
    bool goes_on(const OuterLoop::Outcome& outcome, bool has_changed)
    {
        ++round_;
        return round_ < max_rounds_ && (has_changed || (is_look_ && !is_settled(outcome)));
    }

private:
    int max_iterations_, max_rounds_, round_ = 0, limit_ = 0;
    bool is_look_ = false;
};

} // namespace toile
