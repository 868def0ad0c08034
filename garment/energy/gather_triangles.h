#pragma once

#include "garment/energy/membrane_kernels.h"

namespace toile {

/// Sums the gradients of the corners at vertex v, as GatherCorners, and the energy of the triangles whose
/// corner 0 it is, by a team with a corner per thread.
struct GatherTriangles {
    GatherCorners<CornerPair> corners;
    View<const double> triangle_energy; ///< [triangles] [J]
    View<double> energy;                ///< [vertices] added to [J]

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own) const
    {
        Vec3 force(0.0, 0.0, 0.0);
        double own = 0.0;
        for (int k = corners.first[v] + team.thread; k < corners.first[v + 1]; k += Team::kThreads) {
            const int t = corners.corners[k] / 3, corner = corners.corners[k] % 3;
            const CornerPair g = corners.corner_gradient[t];
            force += corner == 0 ? Vec3(-g.col(0) - g.col(1)) : g.col(corner - 1);
            own += corner == 0 ? triangle_energy[t] : 0.0;
        }
        for (int a = 0; a < 3; ++a)
            force[a] = team.sum(1, force[a]);
        own = team.sum(1, own);
        if (team.thread > 0 || !is_own)
            return;
        corners.gradient[v] += force;
        energy[v] += own;
    }
};

} // namespace toile
