#pragma once

#include "core/compute/cuda/array.h"
#include "core/quadrature/tables/kernel_table.h"

namespace toile {

/// KernelTable in a GPU's memory.
struct DeviceKernelTable {
    int rank = 0; ///< functions of a cluster
    // See KernelView.
    DeviceArray<int> near_first, near_leaf;
    DeviceArray<float> near_weights;
    DeviceArray<int> far_first, far_cluster;
    DeviceArray<float> far_weights;

    /// Table without entries.
    DeviceKernelTable(const CudaSpace& space, int rank, int leaf_count);

    /// Copies the host's table.
    /// @throws DeviceError if the device has too little memory
    DeviceKernelTable(const CudaSpace& space, const KernelTable& table);

    KernelView view() const
    {
        return {near_first.view(), near_leaf.view(),   near_weights.view(),
                far_first.view(),  far_cluster.view(), far_weights.view()};
    }

    /// Copy on the host. Waits.
    KernelTable downloaded() const;

    /// Size of all arrays [bytes].
    std::size_t bytes() const;
};

} // namespace toile
