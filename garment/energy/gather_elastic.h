#pragma once

#include "garment/energy/bending_kernels.h"
#include "garment/energy/membrane_kernels.h"

namespace toile::garment {

/// Sums the corner gradients at a vertex like GatherCorners, by a team of threads and in the single precision
/// of its input.
struct CornersByTeam {
    static constexpr int kAtOnce = 2; ///< corners per thread: covers most vertices, which have six

    View<const int> first;                  ///< [vertices + 1]
    View<const int> corners;                ///< 3 * triangle + corner, ascending per vertex
    View<const CornerPair> corner_gradient; ///< [triangles] [N]

    /// Corners of one thread.
    struct OfThread {
        int begin, end;
        int some[kAtOnce];
    };
    template <typename Team>
    TOILE_HD OfThread of_thread(int v, const Team& team) const
    {
        OfThread local{first[v] + team.thread, first[v + 1], {}};
        for (int n = 0; n < kAtOnce; ++n)
            if (const int k = local.begin + n * Team::kThreads; k < local.end)
                local.some[n] = corners[k];
        return local;
    }

    template <typename Team>
    TOILE_HD PaddedVec3 sum(const Team& team, const OfThread& local) const
    {
        PaddedVec3 sum(0.0F);
        int k = local.begin;
        for (int n = 0; n < kAtOnce; ++n, k += Team::kThreads)
            if (k < local.end)
                add(local.some[n], sum);
        for (; k < local.end; k += Team::kThreads)
            add(corners[k], sum);
        for (int a = 0; a < 3; ++a)
            sum.value[a] = team.sum(1, sum[a]);
        return sum;
    }

private:
    TOILE_HD void add(int slot, PaddedVec3& sum) const
    {
        const int corner = slot % 3;
        const CornerPair g = corner_gradient[slot / 3];
        sum += corner == 0 ? -1.0F * g.column[0] : g.column[corner - 1];
        sum += corner == 0 ? -1.0F * g.column[1] : PaddedVec3(0.0F);
    }
};

/// Adds the gradients of membrane and bending at vertex v. It follows the launch that projects triangles and
/// computes bending while that launch runs.
struct GatherElastic {
    CornersByTeam membrane;
    BendByTeam bending;
    View<Vec3> gradient; ///< [vertices] added to [N]
    View<double> energy; ///< [vertices] bending energy is added [J]

    /// Inputs that do not depend on the projection of the triangles.
    struct Prologue {
        CornersByTeam::OfThread corners;
        BendByTeam::Partial bending;
        Vec3 gradient;
        double energy;
    };
    template <typename Team>
    TOILE_HD Prologue prologue(int v, const Team& team, bool is_in_range) const
    {
        const bool writes = team.thread == 0 && is_in_range;
        return {membrane.of_thread(v, team), bending.of_thread(v, team),
                writes ? gradient[v] : Vec3(0.0, 0.0, 0.0), writes ? energy[v] : 0.0};
    }

    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_in_range) const
    {
        (*this)(v, team, is_in_range, prologue(v, team, is_in_range));
    }
    template <typename Team>
    TOILE_HD void operator()(int v, const Team& team, bool is_in_range, const Prologue& local) const
    {
        const PaddedVec3 pulled = membrane.sum(team, local.corners);
        const BendByTeam::Partial bent = BendByTeam::of_all(team, local.bending);
        if (team.thread != 0 || !is_in_range)
            return;
        gradient[v] = local.gradient + unpadded(pulled) + bent.gradient;
        energy[v] = local.energy + bent.energy;
    }
};

} // namespace toile::garment
