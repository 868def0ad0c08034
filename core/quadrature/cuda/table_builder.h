#pragma once

#include <optional>

#include "core/compute/cuda/scan.h"
#include "core/linear/cuda/inverse_columns.h"
#include "core/quadrature/clusters/cluster_basis.h"
#include "core/quadrature/cuda/kernel_table.h"
#include "core/quadrature/tables/table_kernels.h"

namespace toile {

/// Tabulates H^-1 on a GPU, hundreds of neighbouring targets at a time. The lists equal the CPU's, unless the
/// error of a cluster is within rounding of its limit. Every run gives the same bits, for any block size.
class DeviceTableBuilder {
public:
    /// Targets of a block if the device has the memory. Fewer mean more launches, and the top of the
    /// elimination tree does not fill the device.
    static constexpr int kMaxColumns = 1024;

    /// @param space, basis  borrowed
    /// @param factor        of H, borrowed
    /// @param diagonal      [n] of H [N/m]
    /// @param max_columns  targets of a block, a multiple of DeviceInverseColumns::kColumnMultiple
    /// @throws DeviceError if the device has too little memory for the smallest block and the expected table:
    ///         at construction, with the size. Later if the table is larger than expected.
    DeviceTableBuilder(const CudaSpace& space, const InvertedFactor& factor, View<const double> diagonal,
                       const ClusterBasis& basis, const KernelTable::Settings& settings,
                       int max_columns = kMaxColumns);

    int block_count() const;

    /// Stages of a block's work, to be called in this order for every block: columns of the inverse, their
    /// moments, lists and weights. The last waits for the device once, for the length of the lists.
    void solve(int block);
    void gather_moments();
    void append_lists();

    /// Moves the finished table out.
    DeviceKernelTable take();

private:
    struct BlockSize {
        int columns = 0;    ///< of a full block
        int front_rows = 0; ///< maximum over its fronts
    };

    static BlockSize choose_block(const CudaSpace& space, const InvertedFactor& factor,
                                  const ClusterBasis& basis, int max_columns);
    View<const int> targets() const;
    void upload_tree(View<const double> diagonal, double tolerance);
    void find_entries();
    void count_entries();
    void grow_table(int near_count, int far_count);
    void write_lists(int near_count, int far_count);
    ClusterColumns clusters();
    SlotColumns slots();
    FoundEntries entries();
    EntryOffsets offsets() const;
    int parts() const { return block_.count * block_.parts; }

    const CudaSpace& space_;
    const ClusterBasis& basis_;
    BlockSize size_;
    DeviceInverseColumns inverse_;
    BasisView<double> tree_; ///< on the device
    LeafBlock block_;
    DeviceKernelTable table_;                ///< capacity may exceed its lists
    int near_entries_ = 0, far_entries_ = 0; ///< so far
    DeviceArray<double> leaves_, transfers_, diagonal_, limits_;
    DeviceArray<int> nodes_, row_of_slot_;
    DeviceArray<double> moments_, squares_;
    DeviceArray<int> found_, near_counts_, far_counts_, totals_;
    DeviceArray<long> near_sums_, far_sums_;
    DeviceScratch scratch_;
    PinnedArray<int> totals_on_host_;
};

/// Builds a kernel table on a GPU; the table stays on the device.
/// @param factor    of H
/// @param diagonal  [n] of H [N/m]
/// @param progress  called after every block; may be empty
/// @return nothing if cancelled
/// @throws DeviceError as DeviceTableBuilder, InvalidInput as InvertedFactor
std::optional<DeviceKernelTable> build_kernel_table(const CudaSpace& space, const SupernodalFactor& factor,
                                                    View<const double> diagonal, const ClusterBasis& basis,
                                                    const KernelTable::Settings& settings,
                                                    const BuildProgress& progress);

} // namespace toile
