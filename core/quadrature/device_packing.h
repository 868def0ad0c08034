#pragma once

#include "core/quadrature/cluster_tree.h"
#include "core/quadrature/device_kernel_table.h"
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

    /// Numbers of all arrays [bytes].
    std::size_t bytes() const;
};

/// How accurate packed weights must be.
struct PackingAccuracy {
    View<const double> diagonal; ///< [n] of H [N/m]; none: nothing is packed
    double tolerance = 0.0;      ///< of the table, KernelTable::Settings::tolerance
};

/// A table in two parts whose sums add up to its own, nearly: a byte for every weight where PackingRule
/// allows it, and the rest.
struct PackedTable {
    DevicePackedLists packed;
    DeviceKernelTable rest;
};

/// Waited for. Memory: for a moment both.
/// @throws DeviceError where the device has not the memory
PackedTable pack_table(const CudaSpace& space, DeviceKernelTable table, const ClusterTree& tree,
                       const PackingAccuracy& accuracy);

} // namespace toile
