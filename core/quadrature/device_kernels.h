#pragma once

#include "core/quadrature/leaf_sum.h"
#include "core/quadrature/moments.h"

namespace toile {

/// The right-hand sides of all bodies in the order of the leaves' slots, zero where padded.
struct SortIntoSlots {
    View<const int> nodes; ///< [slots] of one body, -1 where padded
    View<const int> first; ///< [bodies] where a body's nodes begin in b
    View<const Vec3> b;
    View<PaddedVec3> sources; ///< [bodies * slots]

    TOILE_HD void operator()(int k) const
    {
        const int body = k / nodes.size(), v = nodes[k % nodes.size()];
        sources[k] = v >= 0 ? padded(b[first[body] + v]) : PaddedVec3(0.0F);
    }
};

/// First pass: function r of the moments of cluster c of a body.
struct ClimbMoments {
    BasisView<float> basis;
    View<const PaddedVec3> sources; ///< [bodies * slots]
    View<PaddedVec3> moments;       ///< [bodies * clusters * rank]
    int slots, clusters;            ///< of one body

    struct AtSlot {
        View<const PaddedVec3> sources;
        TOILE_HD PaddedVec3 operator()(int slot) const { return sources[slot]; }
    };

    TOILE_HD void operator()(int body, int level, int c, int r) const
    {
        const View<PaddedVec3> own = moments.subview(body * clusters * basis.rank, clusters * basis.rank);
        own[(basis.first_of_level[level] + c) * basis.rank + r] =
            basis.moment(level, c, r, PaddedVec3(0.0F), AtSlot{sources.subview(body * slots, slots)}, own);
    }
};

/// Second pass by a team per leaf: a thread has Width of the eight targets and every so many-th entry of the
/// lists.
template <int Rank, int Width>
struct GatherLeafByTeam {
    static constexpr int kThreadsPerEntry = KernelView::kTargets / Width;

    KernelView table;
    View<const PaddedVec3> sources; ///< [bodies * slots]
    View<const PaddedVec3> moments; ///< [bodies * clusters * rank]
    View<const int> nodes;          ///< [slots]
    View<const int> first;          ///< [bodies] where a body's nodes begin in x
    View<Vec3> x;                   ///< out

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team) const
    {
        const int leaves = nodes.size() / ClusterTree::kLeaf, body = k / leaves, leaf = k % leaves;
        const int clusters = moments.size() / first.size();
        const LeafPart part{Width * (team.thread % kThreadsPerEntry), team.thread / kThreadsPerEntry,
                            Team::kThreads / kThreadsPerEntry};
        LeafSum<Rank, Floats<Width>> sum;
        sum.add(table, sources.subview(body * nodes.size(), nodes.size()),
                moments.subview(body * clusters, clusters), leaf, part);
        for (int a = 0; a < 3; ++a)
            for (int t = 0; t < Width; ++t)
                sum.axis[a].value[t] = team.sum(kThreadsPerEntry, sum.axis[a][t]);

        // All threads of a target hold its sums; the first group writes.
        for (int t = 0; t < Width && part.group == 0; ++t)
            if (const int v = nodes[leaf * ClusterTree::kLeaf + part.first_target + t]; v >= 0)
                x[first[body] + v] =
                    Vec3(double(sum.axis[0][t]), double(sum.axis[1][t]), double(sum.axis[2][t]));
    }
};

/// x = b where the table knows nothing: fixed nodes.
struct CopyOthers {
    View<const int> others; ///< of one body
    View<const int> first;  ///< [bodies]
    View<const Vec3> b;
    View<Vec3> x;

    TOILE_HD void operator()(int k) const
    {
        const int v = first[k / others.size()] + others[k % others.size()];
        x[v] = b[v];
    }
};

} // namespace toile
