#pragma once

#include "core/backend/unroll.h"
#include "garment/energy/membrane_kernels.h"

namespace toile {

/// Sums the gradients of the corners at vertex v, as GatherCorners, by a team of threads and in the single
/// precision that they come in.
struct GatherCornersByTeam {
    View<const int> first;                  ///< [vertices + 1]
    View<const int> corners;                ///< 3 * triangle + corner, ascending per vertex
    View<const CornerPair> corner_gradient; ///< [triangles] [N]
    View<Vec3> gradient;                    ///< [vertices] added to [N]

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own) const
    {
        const bool writes = team.thread == 0 && is_own;
        const Vec3 before = writes ? gradient[v] : Vec3(0.0, 0.0, 0.0); // before others are waited for
        PaddedVec3 sum(0.0F);
        TOILE_UNROLL(2)
        for (int k = first[v] + team.thread; k < first[v + 1]; k += Team::kThreads) {
            const int corner = corners[k] % 3;
            const CornerPair g = corner_gradient[corners[k] / 3];
            sum += corner == 0 ? -1.0F * g.column[0] : g.column[corner - 1];
            sum += corner == 0 ? -1.0F * g.column[1] : PaddedVec3(0.0F);
        }
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        if (writes)
            gradient[v] = before + unpadded(sum);
    }
};

} // namespace toile
