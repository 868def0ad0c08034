#pragma once

#include "core/quadrature/leaf_sum.h"
#include "core/quadrature/moments.h"

namespace toile {

/// A vector and a hole: one load of 16 bytes on a GPU.
using PaddedVec3 = Floats<4>;

TOILE_HD inline PaddedVec3 padded(const Vec3& v)
{
    PaddedVec3 result(0.0F);
    for (int a = 0; a < 3; ++a)
        result.value[a] = float(v[a]);
    return result;
}

/// The right-hand side in the order of the leaves' slots, zero where padded.
struct SortIntoSlots {
    View<const int> nodes; ///< [slots] -1 where padded
    View<const Vec3> b;    ///< [n]
    View<PaddedVec3> sources;

    TOILE_HD void operator()(int slot) const
    {
        const int v = nodes[slot];
        sources[slot] = v >= 0 ? padded(b[v]) : PaddedVec3(0.0F);
    }
};

/// First pass: function r of the moments of cluster c.
struct ClimbMoments {
    BasisView<float> basis;
    View<const PaddedVec3> sources;
    View<PaddedVec3> moments; ///< [rank * clusters]

    struct AtSlot {
        View<const PaddedVec3> sources;
        TOILE_HD PaddedVec3 operator()(int slot) const { return sources[slot]; }
    };

    TOILE_HD void operator()(int level, int c, int r) const
    {
        moments[(basis.first_of_level[level] + c) * basis.rank + r] =
            basis.moment(level, c, r, PaddedVec3(0.0F), AtSlot{sources}, moments);
    }
};

/// Second pass by a team per leaf: a thread has Width of the eight targets and every so many-th entry of the
/// lists.
template <int Rank, int Width>
struct GatherLeafByTeam {
    static constexpr int kThreadsPerEntry = KernelView::kTargets / Width;

    KernelView table;
    View<const PaddedVec3> sources; ///< [slots]
    View<const PaddedVec3> moments; ///< [Rank * clusters]
    View<const int> nodes;          ///< [slots]
    View<Vec3> x;                   ///< [n] out

    template <typename Team>
    TOILE_HD void operator()(int leaf, const Team& team) const
    {
        const LeafPart part{Width * (team.thread % kThreadsPerEntry), team.thread / kThreadsPerEntry,
                            Team::kThreads / kThreadsPerEntry};
        LeafSum<Rank, Floats<Width>> sum;
        sum.add(table, sources, moments, leaf, part);
        for (int a = 0; a < 3; ++a)
            for (int t = 0; t < Width; ++t)
                sum.axis[a].value[t] = team.sum(kThreadsPerEntry, sum.axis[a][t]);

        // All threads of a target hold its sums; the first group writes.
        for (int t = 0; t < Width && part.group == 0; ++t)
            if (const int v = nodes[leaf * ClusterTree::kLeaf + part.first_target + t]; v >= 0)
                x[v] = Vec3(double(sum.axis[0][t]), double(sum.axis[1][t]), double(sum.axis[2][t]));
    }
};

/// x = b where the table knows nothing: fixed nodes.
struct CopyOthers {
    View<const int> others;
    View<const Vec3> b; ///< [n]
    View<Vec3> x;       ///< [n]

    TOILE_HD void operator()(int i) const { x[others[i]] = b[others[i]]; }
};

} // namespace toile
