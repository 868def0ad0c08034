#pragma once

#include <array>

#include "collision/contact_term.h"
#include "core/backend/lanes.h"

namespace toile {

/// What a frozen term answers at one of its vertices, all of it side by side.
struct alignas(16) ActingEntry {
    std::array<int, 4> vertex; ///< as ContactPair's
    std::array<double, 4> weight;
    Vec3 normal;
    FrozenContact at;
    double own_weight;

    static TOILE_HD ActingEntry of(const ContactPair& pair, int slot, const FrozenContact& at)
    {
        return {pair.vertex, pair.weight, pair.normal, at, pair.weight[slot]};
    }

    /// @param p  [vertices] [m]
    TOILE_HD Vec3 times(View<const PaddedVec3> p) const
    {
        Vec3 move(0.0, 0.0, 0.0);
        for (int k = 0; k < 4 && vertex[k] >= 0; ++k)
            move += weight[k] * unpadded(p[vertex[k]]);
        return own_weight * at.times(normal, move);
    }
};

/// Entries of frozen terms that act, by vertex: the first count[k] of those that list k has room for.
struct ActingEntries {
    View<const int> first; ///< [lists + 1] as ContactTouches'
    View<int> count;       ///< [lists]
    View<ActingEntry> entries;
};

} // namespace toile
