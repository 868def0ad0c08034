#pragma once

#include <vector>

#include "collision/contact_turns.h"
#include "core/backend/parallel.h"

namespace toile {

/// Terms that push one after the other, in their TurnOrder, on the CPU.
class HostTurns {
public:
    /// Sweep after sweep, of those that push when it begins or may be pushed on, until none does or nothing
    /// moves.
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
        if (Push::kCarries) {
            deepest_.assign(push.fields()[0].size(), 0.0F);
            parallel_for(kCpu, "contact/find_deepest", order.count, FindDeepest<Push>{push, terms, deepest_});
        }
        parallel_for(kCpu, "contact/flag_acting", order.place_count(),
                     FlagActing<Push>{push, terms, order, deepest_, flags_});
        listed_.clear();
        for (int place = 0; place < order.place_count(); ++place)
            if (flags_[place] != 0)
                listed_.push_back(order.at(place));
    }

    std::vector<float> deepest_;       ///< [vertices] see FindDeepest
    std::vector<unsigned char> flags_; ///< [places]
    std::vector<int> listed_;          ///< terms, in order
};

} // namespace toile
