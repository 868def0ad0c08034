#pragma once

#include <vector>

#include "collision/contact_pushes.h"

namespace toile {

/// Terms that push one after the other, in their TurnOrder.
class HostTurns {
public:
    /// Lists those nearer than the margin [m].
    /// @param terms, x  [vertices] [m], borrowed until the last run()
    void list(View<const ContactTerm> terms, View<Vec3> x, double margin);

    /// Lets those push, sweep after sweep.
    /// @param push    (i, term) -> whether it moved something
    /// @param margin  within which a term was listed that might push what moves [m]; where something goes
    ///                too far for that nothing stays moved
    template <typename Push>
    PushOutcome run(const Push& push, int sweeps, double margin = HUGE_VAL)
    {
        PushOutcome outcome;
        const WatchedPush<Push> watched{push, terms_, x_, start_, margin, {&outcome, 1}};
        bool is_still = false; // a sweep that changes nothing would change nothing again
        for (int sweep = 0; sweep < sweeps && !is_still; ++sweep) {
            is_still = true;
            for (const int i : listed_)
                is_still = !watched(i, terms_[i]) && is_still;
        }
        if (outcome.went_far != 0)
            put_back();
        return outcome;
    }

private:
    void put_back();

    View<const ContactTerm> terms_;
    View<Vec3> x_;
    std::vector<unsigned char> flags_; ///< [places]
    std::vector<int> listed_;          ///< terms, in order
    std::vector<Vec3> start_;          ///< [vertices] those of listed terms
};

} // namespace toile
