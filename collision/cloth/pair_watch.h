#pragma once

#include "collision/cloth/near_pairs.h"

namespace toile {

/// Where a vertex goes now.
struct ChangedWay {
    int vertex;
    Vec3 way;       ///< [m]
    double strayed; ///< [m] from where it wants to go, and how far it may go on straying: see KnownWays
};

/// A pair that is in its own way.
struct BlockedPair {
    NearPair pair;
    double share; ///< [-] of its vertices' ways that it allows, below 1
};

/// The pairs of a SafeStep and the ways of their vertices, kept where pairs are looked for.
class PairWatch {
public:
    PairWatch() = default;
    virtual ~PairWatch() = default;
    PairWatch(const PairWatch&) = delete;
    PairWatch& operator=(const PairWatch&) = delete;

    /// All pairs that are in their way after some vertices have changed theirs, in an order that is the same
    /// in every run. Pairs that the lists may miss are looked for first. Borrowed until the next look.
    /// @param changed  each vertex once
    virtual View<const BlockedPair> look(View<const ChangedWay> changed) = 0;
};

} // namespace toile
