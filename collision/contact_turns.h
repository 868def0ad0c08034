#pragma once

/// Terms that push one after the other, as Turns has them.

#include "collision/contact_pushes.h"
#include "core/backend/turns.h"

namespace toile {

/// Flags the place of term i where it pushes; for i in [0, place_count()), as places beyond the terms are
/// empty.
template <typename Push>
struct FlagActing {
    Push push;
    View<const ContactTerm> terms;
    TurnOrder order;
    View<unsigned char> flags; ///< [places] out

    TOILE_HD void operator()(int i) const
    {
        flags[order.place_of(i)] = i < order.count && push.acts(i, terms[i]) ? 1 : 0;
    }
};

/// A push of a listed term.
template <typename Push>
struct PushInTurn {
    Push push;
    View<const ContactTerm> terms;
    View<int> moved; ///< [1] becomes 1 where something moves

    TOILE_HD TermInTurn prepare(int i) const { return push.prepare(terms[i]); }
    TOILE_HD std::array<int, 4> shared(const TermInTurn& own) const { return own.term.pair.vertex; }
    TOILE_HD void operator()(int i, const TermInTurn& own) const
    {
        if (push(i, own))
            moved[0] = 1;
    }
};

/// What terms share with each other.
struct VerticesOfTerm {
    View<const ContactTerm> terms;
    TOILE_HD std::array<int, 4> operator()(int i) const { return terms[i].pair.vertex; }
};

} // namespace toile
