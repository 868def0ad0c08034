#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/linear/supernodal_factor.h"
#include "core/quadrature/clusters/cluster_basis.h"
#include "core/quadrature/clusters/leaf_sum.h"

namespace toile {

/// Rows of the kernel G = H^-1, tabulated for quadrature: exact towards nodes nearby, projected onto the
/// functions of a cluster towards nodes far away,
///
///   q_i = sum_{j near i} G_ij r_j + sum_{C far from i} w_iC . m_C
///   w_iC = P_C^T G_{C,i},   m_C = P_C^T r_C
///
/// [Barnes & Hut 1986 applied to eq. 7 of the paper]. The eight targets of a leaf share their lists.
struct KernelTable {
    static constexpr int kTargets = KernelView::kTargets;
    static constexpr int kNearWeights = ClusterTree::kLeaf * kTargets; ///< [source node][target]

    struct Settings {
        /// [-] A cluster is far from a leaf if its functions represent the kernel's rows to this accuracy:
        ///
        ///   sqrt(H_ii mean_C(H_jj)) |G_iC - P_C P_C^T G_iC| <= tolerance (|C| / 8)^(1/4)
        ///
        /// for the eight targets i. Volumes need about 0.07. Smaller: more accurate, longer lists.
        /// Measurements: docs/journal/quadrature.md.
        double tolerance = 0.2;
    };

    int rank = 3;                    ///< functions of a cluster
    std::vector<int> near_first;     ///< [leaves + 1] into near_leaf
    std::vector<int> near_leaf;      ///< source leaves, ascending per target leaf
    std::vector<float> near_weights; ///< [near_leaf][kNearWeights] [m/N]
    std::vector<int> far_first;      ///< [leaves + 1] into far_cluster
    std::vector<int> far_cluster;    ///< source clusters
    std::vector<float> far_weights;  ///< [far_cluster][rank][kTargets] [m/N]

    KernelView view() const
    {
        return {near_first, near_leaf, near_weights, far_first, far_cluster, far_weights};
    }

    /// Entries that a target reads, averaged over the leaves.
    double gathers_per_node() const;
};

/// Callback with the finished fraction (0, 1], from any of the building threads; false cancels.
using BuildProgress = std::function<bool(double)>;

/// Tabulates H^-1 from its factor: n solves, with 32 right-hand sides at a time, on all threads. Memory:
/// twice the table and two blocks of n x 32 numbers per thread.
/// @param factor    of H
/// @param diagonal  [n] of H [N/m]
/// @return nothing if cancelled
std::optional<KernelTable> build_kernel_table(const SupernodalFactor& factor, View<const double> diagonal,
                                              const ClusterBasis& basis,
                                              const KernelTable::Settings& settings,
                                              const BuildProgress& progress);

} // namespace toile
