#pragma once

#include <cmath>
#include <vector>

#include "collision/contact.h"

namespace toile {

/// What sweeps over near terms have moved, so that it is noticed when a vertex has come so far that other
/// terms may push.
class NearMoves {
public:
    explicit NearMoves(const NearTerms& near) : near_(near), has_moved_(near.terms.size(), 0) {}

    /// Takes note that term i has moved its vertices in near.x. False where others may push them then: one
    /// whose terms are not all here has gone by nearly half of the margin or more. The weights of cloth with
    /// cloth sum to 2.
    bool note(int i)
    {
        if (!has_moved_[i])
            moved_.push_back(i);
        has_moved_[i] = 1;
        const ContactPair& pair = near_.terms[i].pair;
        for (int k = 0; k < pair.count() && !near_.start.empty(); ++k)
            if (!near_.start[i].has_all[k] &&
                !((near_.x[pair.vertex[k]] - near_.start[i].x[k]).norm() < 0.49 * near_.margin))
                return false;
        return true;
    }

    View<const int> moved() const { return moved_; } ///< terms

private:
    const NearTerms& near_;
    std::vector<unsigned char> has_moved_; ///< [terms]
    std::vector<int> moved_;
};

/// Sweeps over terms that push where they are pressed, moving near.x, as if over all of them: where a vertex
/// comes so far that others might push it begins anew with more.
/// Short moves need no more than the terms that are very near; long ones those beside them too, which may be
/// several times as many.
/// @param sweeps  (near, moves) -> false where moves.note() was after a push
template <typename Sweeps>
void Contact::sweep_near(StepField positions, ExpectedMoves expected, const Sweeps& sweeps) const
{
    constexpr double kMargin = 0.0001; // [m]
    terms_->see(positions);
    double margin = kMargin;
    for (bool with_beside = expected == ExpectedMoves::Long;; with_beside = true) {
        const NearTerms near = terms_->near(margin, with_beside);
        if (near.terms.empty())
            return;
        NearMoves moves(near);
        if (sweeps(near, moves))
            return terms_->take(near, moves.moved());
        if (with_beside)
            margin = margin < 1.0 ? 4.0 * margin : HUGE_VAL;
    }
}

} // namespace toile
