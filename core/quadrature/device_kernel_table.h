#pragma once

#include "core/backend/cuda/array.h"
#include "core/quadrature/kernel_table.h"

namespace toile {

/// A KernelTable in a GPU's memory.
struct DeviceKernelTable {
    int rank = 0; ///< functions of a cluster
    // As KernelView's.
    DeviceArray<int> near_first, near_leaf;
    DeviceArray<float> near_weights;
    DeviceArray<int> far_first, far_cluster;
    DeviceArray<float> far_weights;

    /// Lists without entries.
    DeviceKernelTable(const CudaSpace& space, int rank, int leaf_count);

    /// A copy of the host's.
    /// @throws DeviceError where the device has not the memory
    DeviceKernelTable(const CudaSpace& space, const KernelTable& table);

    KernelView view() const
    {
        return {near_first.view(), near_leaf.view(),   near_weights.view(),
                far_first.view(),  far_cluster.view(), far_weights.view()};
    }

    /// Waited for.
    KernelTable downloaded() const;

    /// Numbers of all arrays [bytes].
    std::size_t bytes() const;
};

} // namespace toile
