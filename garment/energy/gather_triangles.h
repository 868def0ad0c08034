#pragma once

#include "core/backend/unroll.h"
#include "garment/energy/membrane_kernels.h"

namespace toile {

/// Sums the gradients of the corners at vertex v, as GatherCorners, by a team of threads and in the single
/// precision that they come in.
struct GatherByTeam {
    GatherCorners<CornerPair> corners;

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own) const
    {
        PaddedVec3 sum(0.0F);
        TOILE_UNROLL(2)
        for (int k = corners.first[v] + team.thread; k < corners.first[v + 1]; k += Team::kThreads) {
            const int corner = corners.corners[k] % 3;
            const CornerPair g = corners.corner_gradient[corners.corners[k] / 3];
            sum += corner == 0 ? -1.0F * g.column[0] : g.column[corner - 1];
            sum += corner == 0 ? -1.0F * g.column[1] : PaddedVec3(0.0F);
        }
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        if (team.thread == 0 && is_own)
            corners.gradient[v] += unpadded(sum);
    }
};

} // namespace toile
