#pragma once

#include <optional>

#include "core/backend/cuda/scan.h"
#include "core/linear/device_inverse_columns.h"
#include "core/quadrature/cluster_basis.h"
#include "core/quadrature/device_kernel_table.h"
#include "core/quadrature/table_kernels.h"

namespace toile {

/// Tabulates H^-1 on a GPU, hundreds of neighbouring targets at a time: the same lists as on the CPU, except
/// where the accuracy of a cluster is within rounding of its limit. The same bits in every run, however many
/// targets a block has.
class DeviceTableBuilder {
public:
    /// Targets of a block where the device has the memory. Fewer: more launches, and the top of the
    /// elimination tree does not fill the device.
    static constexpr int kMostColumns = 1024;

    /// @param space, basis  borrowed
    /// @param factor        of H, borrowed
    /// @param diagonal      [n] of H [N/m]
    /// @param most_columns  targets of a block, a multiple of DeviceInverseColumns::kColumnMultiple
    /// @throws DeviceError where the device has not the memory for the smallest block and the table that H
    ///         probably has: with its size, before anything is done. Later where the table is larger.
    DeviceTableBuilder(const CudaSpace& space, const InvertedFactor& factor, View<const double> diagonal,
                       const ClusterBasis& basis, const KernelTable::Settings& settings,
                       int most_columns = kMostColumns);

    int block_count() const;

    /// The parts of a block's work, to be called in this order, block after block: columns of the inverse;
    /// their moments; lists and weights. The last waits for the device once, to know how long lists are.
    void solve(int block);
    void gather_moments();
    void append_lists();

    /// The finished table; nothing is left here.
    DeviceKernelTable take();

private:
    struct BlockSize {
        int columns = 0;    ///< of a full block
        int front_rows = 0; ///< of its fronts, at most
    };

    static BlockSize choose_block(const CudaSpace& space, const InvertedFactor& factor,
                                  const ClusterBasis& basis, int most_columns);
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
    DeviceKernelTable table_;                ///< its arrays may be longer than its lists
    int near_entries_ = 0, far_entries_ = 0; ///< so far
    DeviceArray<double> leaves_, transfers_, diagonal_, limits_;
    DeviceArray<int> nodes_, row_of_slot_;
    DeviceArray<double> moments_, squares_;
    DeviceArray<int> found_, near_counts_, far_counts_, totals_;
    DeviceArray<long> near_sums_, far_sums_;
    DeviceScratch scratch_;
    PinnedArray<int> totals_on_host_;
};

/// build_kernel_table on a GPU: the table stays there.
/// @param factor    of H
/// @param diagonal  [n] of H [N/m]
/// @param progress  called after every block; may be empty
/// @return nothing when cancelled
/// @throws DeviceError as DeviceTableBuilder, InvalidInput as InvertedFactor
std::optional<DeviceKernelTable> build_kernel_table(const CudaSpace& space, const SupernodalFactor& factor,
                                                    View<const double> diagonal, const ClusterBasis& basis,
                                                    const KernelTable::Settings& settings,
                                                    const BuildProgress& progress);

} // namespace toile
