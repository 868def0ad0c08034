#pragma once

#include <vector>

#include "collision/contact_turns.h"
#include "core/backend/parallel.h"

namespace toile {

/// Terms that push one after the other, in their TurnOrder, on the CPU.
class HostTurns {
public:
    /// Sweep after sweep, of those that push when it begins, until none does or nothing moves.
    /// @return whether something moved
    template <typename Push>
    bool sweep(View<const ContactTerm> terms, const Push& push, int sweeps)
    {
        bool moved = false;
        for (int done = 0; done < sweeps; ++done) {
            bool moves = false;
            list(terms, push);
            for (const int i : listed_)
                moves |= push(i, push.prepare(terms[i]));
            if (!moves)
                break;
            moved = true;
        }
        return moved;
    }

private:
    template <typename Push>
    void list(View<const ContactTerm> terms, const Push& push)
    {
        const TurnOrder order{terms.size()};
        flags_.resize(order.place_count());
        parallel_for(kCpu, "contact/flag_acting", order.place_count(),
                     FlagActing<Push>{push, terms, order, flags_});
        listed_.clear();
        for (int place = 0; place < order.place_count(); ++place)
            if (flags_[place] != 0)
                listed_.push_back(order.at(place));
    }

    std::vector<unsigned char> flags_; ///< [places]
    std::vector<int> listed_;          ///< terms, in order
};

} // namespace toile
