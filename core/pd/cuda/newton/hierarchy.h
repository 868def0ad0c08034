#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/newton/hierarchy_kernels.h"

namespace toile {

/// Coarse part of a preconditioner on a GPU: the additive hierarchy
///
///   sum_l P_l D_l^-1 P_l^T
///
/// over the levels of a ClusterHierarchy, D_l the blocks of the Galerkin matrix P_l^T K P_l. It needs no
/// large factor, and its cost per vertex does not grow.
class DeviceHierarchy {
public:
    /// @param space  borrowed
    DeviceHierarchy(const CudaSpace& space, const ClusterHierarchy& clusters);

    /// Takes other fixed vertices, whose functions vanish. [vertices]
    void set_fixed(const std::vector<unsigned char>& fixed);

    /// Makes the inverses for another Hessian. Enqueued.
    void update(const SlicedHessian& hessian, const FrozenTerms& terms);

    /// Enqueues the solution for the field that ClusterFields has restricted.
    void solve();

    /// Restriction before solve(), prolongation after it.
    ClusterFields fields();

    int cluster_count() const { return first_vertex_.size() - 1; }

private:
    struct LevelArrays {
        LevelArrays(const CudaSpace& space, const ClusterHierarchy::Level& level);
        HierarchyView::Level view(int first_item) const;

        DeviceArray<int> cluster_of, first_of_cluster, end_of_cluster, block_of, slot_of, first_of_block;
        DeviceArray<ClusterHierarchy::Transfer> transfer;
        int block_count;
    };
    HierarchyView view() const;

    const CudaSpace& space_;
    std::vector<PaddedVec3> functions_on_host_;
    DeviceArray<int> first_vertex_, vertices_, cluster_of_, level_of_item_, first_of_level_;
    DeviceArray<PaddedVec3> functions_;
    std::vector<LevelArrays> levels_;
    std::vector<int> cluster_counts_;      ///< [levels]
    DeviceArray<float> panels_, inverses_; ///< see AssembleClusters, MultiplyInverses
    DeviceArray<float> restricted_, solution_;
};

} // namespace toile
