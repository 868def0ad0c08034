#pragma once

/// Terms that push one after the other, as Turns has them.

#include <array>
#include <cmath>

#include "collision/contact_pushes.h"
#include "core/backend/shared_bounds.h"
#include "core/backend/turns.h"

namespace toile {

/// The largest depth of those that push at each vertex; for term i.
template <typename Push>
struct FindDeepest {
    Push push;
    View<const ContactTerm> terms;
    View<float> deepest; ///< [vertices] [m] out; 0 before

    TOILE_HD void operator()(int i) const
    {
        const double depth = push.depth(i, terms[i]);
        if (depth <= 0.0)
            return;
        for (const int v : terms[i].pair.vertex)
            if (v >= 0)
                raise_shared(deepest[v], float(depth));
    }
};

/// Flags the place of term i where it pushes or may be pushed on; for i in [0, place_count()), as places
/// beyond the terms are empty.
template <typename Push>
struct FlagActing {
    Push push;
    View<const ContactTerm> terms;
    TurnOrder order;
    View<const float> deepest; ///< see FindDeepest; not looked at where the push carries nothing
    View<unsigned char> flags; ///< [places] out

    TOILE_HD void operator()(int i) const
    {
        flags[order.place_of(i)] = i < order.count && has_turn(i, terms[i]) ? 1 : 0;
    }

private:
    TOILE_HD bool has_turn(int i, const ContactTerm& term) const
    {
        const double depth = push.depth(i, term);
        if (!Push::kCarries)
            return depth > 0.0;
        if (depth > -kSurelyOut)
            return true;
        float others = 0.0F;
        for (const int v : term.pair.vertex)
            if (v >= 0)
                others = std::fmax(others, deepest[v]);
        return -depth < std::fmin(kCarry * others, kFarthestCarried);
    }
};

/// A push of a listed term on what its vertices have: own[f][k] is that of its vertex k, so that the vertices
/// of the prepared pair are 0 to 3, or -1 where unused.
template <typename Push>
struct PushInTurn {
    static constexpr int kFields = Push::kFields;

    Push push;
    View<const ContactTerm> terms;

    struct Prepared {
        TermInTurn here;           ///< found with the numbers below, then numbered anew
        std::array<int, 4> vertex; ///< in the fields
    };

    TOILE_HD SharedFields<kFields> fields() const { return push.fields(); }
    TOILE_HD Prepared prepare(int i) const
    {
        Prepared prepared{push.prepare(terms[i]), terms[i].pair.vertex};
        std::array<int, 4>& vertex = prepared.here.term.pair.vertex;
        for (int k = 0; k < 4; ++k)
            vertex[k] = vertex[k] < 0 ? -1 : k;
        return prepared;
    }
    TOILE_HD std::array<int, 4> shared(const Prepared& prepared) const { return prepared.vertex; }
    TOILE_HD void operator()(int i, const Prepared& prepared, OwnFields<kFields>& own) const
    {
        SharedFields<kFields> there;
        for (int f = 0; f < kFields; ++f)
            there[f] = View<Vec3>(own[f].data(), 4);
        push.over(there)(i, prepared.here);
    }
};

/// What terms share with each other.
struct VerticesOfTerm {
    View<const ContactTerm> terms;
    TOILE_HD std::array<int, 4> operator()(int i) const { return terms[i].pair.vertex; }
};

} // namespace toile
