#pragma once

#include <cmath>
#include <vector>

#include "collision/contact.h"

namespace toile {

/// Where vertices of near terms began, so that it is noticed when they have come so far that other terms may
/// push. Does nothing where the near terms are all.
class NearMoves {
public:
    /// @param x  [vertices] where the terms are near [m]
    NearMoves(const NearTerms& near, View<const Vec3> x) : near_(near)
    {
        if (std::isinf(near.margin))
            return;
        start_.resize(4 * size_t(near.terms.size()));
        for (int i = 0; i < near.terms.size(); ++i)
            for (int k = 0; k < near.terms[i].pair.count(); ++k)
                start_[4 * i + k] = x[near.terms[i].pair.vertex[k]];
    }

    /// True where a vertex of term i has moved by nearly half of the margin or more: the weights of cloth
    /// with cloth sum to 2.
    bool are_far(int i, View<const Vec3> x) const
    {
        if (start_.empty())
            return false;
        const ContactPair& pair = near_.terms[i].pair;
        bool is_far = false;
        for (int k = 0; k < pair.count(); ++k)
            is_far = is_far || !((x[pair.vertex[k]] - start_[4 * i + k]).norm() < 0.49 * near_.margin);
        return is_far;
    }

    void undo(View<Vec3> x) const
    {
        for (int i = 0; !start_.empty() && i < near_.terms.size(); ++i)
            for (int k = 0; k < near_.terms[i].pair.count(); ++k)
                x[near_.terms[i].pair.vertex[k]] = start_[4 * i + k];
    }

private:
    const NearTerms& near_;
    std::vector<Vec3> start_; ///< [4 x terms] by term and vertex [m]
};

/// Sweeps over terms that push where they are pressed, moving x, as if over all of them: where a vertex comes
/// so far that others might push it begins anew with more.
/// @param sweeps  (near, moves, x) -> false where moves.are_far() after a push
template <typename Sweeps>
void Contact::sweep_near(StepField positions, const Sweeps& sweeps) const
{
    constexpr double kMargin = 0.002; // [m]
    terms_->see(positions);
    for (double margin = kMargin;; margin = margin < 1.0 ? 4.0 * margin : HUGE_VAL) {
        const NearTerms near = terms_->near(margin);
        if (near.terms.empty())
            return;
        const View<Vec3> x = positions.change_on_host();
        const NearMoves moves(near, x);
        if (sweeps(near, moves, x))
            return;
        moves.undo(x);
    }
}

} // namespace toile
