#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/linear/cuda/batched_inverses.h"
#include "core/pd/cuda/newton/hierarchy_kernels.h"

namespace toile {

/// Coarse part of a preconditioner on a GPU: with the functions p of clusters and q of regions
/// (ClusterHierarchy),
///
///   p D^-1 p^T + q E^-1 q^T,
///
/// D the blocks of p^T K p, which may overlap, and E those of q^T K q that belong to one component.
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
    HierarchyView view();

    const CudaSpace& space_;
    int functions_of_cluster_;
    std::vector<PaddedVec3> functions_on_host_;
    DeviceArray<int> first_vertex_, vertices_, cluster_of_;
    DeviceArray<PaddedVec3> functions_;
    DeviceArray<int> first_neighbour_, neighbours_, first_member_, first_copy_;
    DeviceArray<ClusterHierarchy::Member> members_;
    DeviceArray<ClusterHierarchy::Copy> copies_;
    DeviceArray<int> first_region_, component_of_, region_of_;
    DeviceArray<ClusterHierarchy::Transfer> transfers_;
    DeviceArray<ClusterHierarchy::Range> clusters_of_region_;
    BatchedInverses inverses_;                                            ///< see HierarchyView
    DeviceArray<double> couplings_;                                       ///< see AssembleClusters
    DeviceArray<float> restricted_, to_regions_, of_copies_, of_regions_; ///< see ClusterFields
};

} // namespace toile
