#pragma once

#include <array>

#include "collision/contact/term.h"
#include "core/compute/lanes.h"

namespace toile::collision {

/// Row of a frozen term's Hessian at one of its vertices, stored contiguously.
struct alignas(16) ActiveRow {
    std::array<int, 4> vertex; ///< see ContactPair
    std::array<double, 4> weight;
    Vec3 normal;
    FrozenContact at;
    double self_weight;

    static TOILE_HD ActiveRow of(const ContactPair& pair, int slot, const FrozenContact& at)
    {
        return {pair.vertex, pair.weight, pair.normal, at, pair.weight[slot]};
    }

    /// @param p  [vertices] [m]
    TOILE_HD Vec3 times(View<const PaddedVec3> p) const
    {
        Vec3 move(0.0, 0.0, 0.0);
        for (int k = 0; k < 4 && vertex[k] >= 0; ++k)
            move += weight[k] * unpadded(p[vertex[k]]);
        return self_weight * at.times(normal, move);
    }
};

/// Rows of active frozen terms by vertex. List k uses the first count[k] of its slots.
struct ActiveRows {
    View<const int> first; ///< [lists + 1] see ContactIncidence
    View<int> count;       ///< [lists]
    View<ActiveRow> entries;
};

} // namespace toile::collision
