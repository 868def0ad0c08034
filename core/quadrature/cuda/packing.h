#pragma once

#include "core/quadrature/clusters/cluster_tree.h"
#include "core/quadrature/cuda/kernel_table.h"
#include "core/quadrature/packed_lists.h"

namespace toile {

/// PackedView in a GPU's memory.
struct DevicePackedLists {
    DeviceArray<int> near_first, near_leaf;
    DeviceArray<std::uint32_t> near_codes;
    DeviceArray<float> near_scales;
    DeviceArray<int> far_first, far_cluster;
    DeviceArray<std::uint32_t> far_codes;
    DeviceArray<float> far_scales;

    /// Lists without entries.
    DevicePackedLists(const CudaSpace& space, int leaf_count);

    PackedView view() const
    {
        return {near_first.view(), near_leaf.view(),   near_codes.view(), near_scales.view(),
                far_first.view(),  far_cluster.view(), far_codes.view(),  far_scales.view()};
    }

    /// Size of all arrays [bytes].
    std::size_t bytes() const;
};

/// Accuracy required of packed weights.
struct PackingAccuracy {
    View<const double> diagonal; ///< [n] of H [N/m]; empty: nothing is packed
    double tolerance = 0.0;      ///< of the table, KernelTable::Settings::tolerance
};

/// Table in two parts whose sums approximately add up to the original's: entries with a byte per weight, if
/// PackingRule allows it, and the rest.
struct PackedTable {
    DevicePackedLists packed;
    DeviceKernelTable rest;
};

/// Splits a table. Waits. Needs memory for both at once.
/// @throws DeviceError if the device has too little memory
PackedTable pack_table(const CudaSpace& space, DeviceKernelTable table, const ClusterTree& tree,
                       const PackingAccuracy& accuracy);

} // namespace toile
