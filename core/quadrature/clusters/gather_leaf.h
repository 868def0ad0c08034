#pragma once

#include "core/quadrature/clusters/leaf_sum.h"

namespace toile {

/// Leaves or clusters per task: few enough to balance the load, a few microseconds each.
inline constexpr int kLeafGrain = 16;

/// LeafSum on the CPU: all targets of a leaf together.
template <int Rank>
struct GatherLeaf {
    KernelView table;
    View<const Eigen::Vector3f> sources; ///< [slots] r
    View<const Eigen::Vector3f> moments; ///< [Rank * clusters] m
    View<const int> nodes;               ///< [slots] node of every slot, -1 for padding
    View<Vec3> x;                        ///< [n] out

    void operator()(int leaf) const
    {
        LeafSum<Rank, FloatLanes> sum;
        sum.add_near(table, sources, table.near_of(leaf), {});
        sum.add_far(table, moments, table.far_of(leaf), {});
        for (int t = 0; t < KernelView::kTargets; ++t)
            if (const int v = nodes[leaf * ClusterTree::kLeaf + t]; v >= 0)
                x[v] = Vec3(double(sum.axis[0][t]), double(sum.axis[1][t]), double(sum.axis[2][t]));
    }
};

} // namespace toile
