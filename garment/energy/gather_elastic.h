#pragma once

#include "garment/energy/bending_kernels.h"
#include "garment/energy/membrane_kernels.h"

namespace toile {

/// Sums the gradients of the corners at a vertex, as GatherCorners, by a team of threads and in the single
/// precision that they come in.
struct CornersByTeam {
    static constexpr int kAtOnce = 2; ///< corners of a thread: all of most vertices, which have six

    View<const int> first;                  ///< [vertices + 1]
    View<const int> corners;                ///< 3 * triangle + corner, ascending per vertex
    View<const CornerPair> corner_gradient; ///< [triangles] [N]

    /// A thread's corners.
    struct OfThread {
        int begin, end;
        int some[kAtOnce];
    };
    template <typename Team>
    TOILE_HD OfThread of_thread(int v, const Team& team) const
    {
        OfThread own{first[v] + team.thread, first[v + 1], {}};
        for (int n = 0; n < kAtOnce; ++n)
            if (const int k = own.begin + n * Team::kThreads; k < own.end)
                own.some[n] = corners[k];
        return own;
    }

    template <typename Team>
    TOILE_HD PaddedVec3 sum(const Team& team, const OfThread& own) const
    {
        PaddedVec3 sum(0.0F);
        int k = own.begin;
        for (int n = 0; n < kAtOnce; ++n, k += Team::kThreads)
            if (k < own.end)
                add(own.some[n], sum);
        for (; k < own.end; k += Team::kThreads)
            add(corners[k], sum);
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        return sum;
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

/// Adds what membrane and bending pull at vertex v. Comes right after the launch that projects triangles, and
/// bends while that runs.
struct GatherElastic {
    CornersByTeam membrane;
    BendByTeam bending;
    View<Vec3> gradient; ///< [vertices] added to [N]
    View<double> energy; ///< [vertices] added to, of bending [J]

    /// All but what the triangles found.
    struct Early {
        CornersByTeam::OfThread corners;
        BendByTeam::Share bending;
        Vec3 gradient;
        double energy;
    };
    template <typename Team>
    TOILE_HD Early early(int v, const Team& team, bool is_own) const
    {
        const bool writes = team.thread == 0 && is_own;
        return {membrane.of_thread(v, team), bending.of_thread(v, team),
                writes ? gradient[v] : Vec3(0.0, 0.0, 0.0), writes ? energy[v] : 0.0};
    }

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own) const
    {
        (*this)(v, team, is_own, early(v, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_own, const Early& own) const
    {
        const PaddedVec3 pulled = membrane.sum(team, own.corners);
        const BendByTeam::Share bent = BendByTeam::of_all(team, own.bending);
        if (team.thread != 0 || !is_own)
            return;
        gradient[v] = own.gradient + unpadded(pulled) + bent.gradient;
        energy[v] = own.energy + bent.energy;
    }
};

} // namespace toile
