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

    /// All but what the triangles found, in the launch before: a thread's corners, of which most vertices
    /// have six, and the gradient so far.
    struct Early {
        static constexpr int kCorners = 2;
        int begin, end;
        int corners[kCorners];
        Vec3 before;
    };
    template <typename Team>
    TOILE_HD Early early(int v, const Team& team, bool is_own) const
    {
        Early own{first[v] + team.thread, first[v + 1], {}, Vec3(0.0, 0.0, 0.0)};
        for (int n = 0; n < Early::kCorners; ++n)
            if (const int k = own.begin + n * Team::kThreads; k < own.end)
                own.corners[n] = corners[k];
        if (team.thread == 0 && is_own)
            own.before = gradient[v];
        return own;
    }

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own) const
    {
        (*this)(v, team, is_own, early(v, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own, const Early& own) const
    {
        PaddedVec3 sum(0.0F);
        int k = own.begin;
        for (int n = 0; n < Early::kCorners; ++n, k += Team::kThreads)
            if (k < own.end)
                add(own.corners[n], sum);
        for (; k < own.end; k += Team::kThreads)
            add(corners[k], sum);
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        if (team.thread == 0 && is_own)
            gradient[v] = own.before + unpadded(sum);
    }

private:
    TOILE_HD void add(int place, PaddedVec3& sum) const
    {
        const int corner = place % 3;
        const CornerPair g = corner_gradient[place / 3];
        sum += corner == 0 ? -1.0F * g.column[0] : g.column[corner - 1];
        sum += corner == 0 ? -1.0F * g.column[1] : PaddedVec3(0.0F);
    }
};

} // namespace toile
