#pragma once

#include "core/backend/lanes.h"
#include "core/quadrature/kernel_table.h"

namespace toile {

/// Leaves or clusters per task: small enough to balance, a few microseconds each.
inline constexpr int kLeafGrain = 16;

/// Second pass of quadrature for the targets of one leaf: q_i = sum_near G_ij r_j + sum_far w_iC . m_C
/// Rank: the table's, known to the compiler so that the inner loop is unrolled.
template <int Rank>
struct GatherLeaf {
    const KernelTable& table;
    View<const Eigen::Vector3f> sources; ///< [slots] r
    View<const Eigen::Vector3f> moments; ///< [Rank * clusters] m
    View<const int> nodes;               ///< [slots] node of every slot, -1 for padding
    View<Vec3> x;                        ///< [n] out

    void operator()(int leaf) const
    {
        Sum sum;
        for (int e = table.near_first[leaf]; e < table.near_first[leaf + 1]; ++e)
            sum.template add<ClusterTree::kLeaf>(table.near_weights.data() +
                                                     size_t(e) * KernelTable::kNearWeights,
                                                 &sources[table.near_leaf[e] * ClusterTree::kLeaf]);
        for (int e = table.far_first[leaf]; e < table.far_first[leaf + 1]; ++e)
            sum.template add<Rank>(table.far_weights.data() + size_t(e) * Rank * KernelTable::kTargets,
                                   &moments[table.far_cluster[e] * Rank]);
        for (int t = 0; t < KernelTable::kTargets; ++t)
            if (const int v = nodes[leaf * ClusterTree::kLeaf + t]; v >= 0)
                x[v] = Vec3(sum.of(0, t), sum.of(1, t), sum.of(2, t));
    }

private:
    /// x, y and z of the eight targets, a lane each.
    struct Sum {
        FloatLanes axis[3] = {FloatLanes(0.0F), FloatLanes(0.0F), FloatLanes(0.0F)};

        /// Adds weights [Count][kTargets] times values [Count].
        template <int Count>
        void add(const float* weights, const Eigen::Vector3f* values)
        {
            for (int k = 0; k < Count; ++k) {
                const FloatLanes weight = load(weights + k * KernelTable::kTargets);
                for (int a = 0; a < 3; ++a)
                    axis[a] += weight * values[k][a];
            }
        }
        double of(int a, int target) const { return double(axis[a][target]); }
    };
};

} // namespace toile
