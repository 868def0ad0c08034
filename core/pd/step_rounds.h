#pragma once

#include <algorithm>

#include "core/pd/outer_loop.h"

namespace toile {

/// How the iterations of a step are shared out among its minimisations. Each begins where the last has ended,
/// with what contact has then looked at anew. The first ones are cut short where something touches: what they
/// find is near enough to see what will touch what and how hard, and what is minimised before that is known
/// is for nothing.
class StepRounds {
public:
    /// Minimisations cut short, and their iterations, which do not count as the step's.
    static constexpr int kLooks = 2, kIterationsOfLook = 6;

    /// @param max_iterations  of all minimisations of the step that are not cut short
    /// @param max_rounds      minimisations that are not cut short
    StepRounds(int max_iterations, int max_rounds) : left_(max_iterations), rounds_(max_rounds + kLooks) {}

    /// Limit of the next minimisation.
    int next(bool touches)
    {
        touches_ = touches;
        limit_ = touches && round_ < kLooks ? std::min(kIterationsOfLook, left_) : left_;
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
        if (round_++ >= kLooks || !touches_)
            left_ -= outcome.iterations;
        return left_ > 0 && round_ < rounds_ && (has_changed || !is_settled(outcome));
    }

private:
    int left_, rounds_, round_ = 0, limit_ = 0;
    bool touches_ = false;
};

} // namespace toile
