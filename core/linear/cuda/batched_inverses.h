#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/linear/cuda/batched_inverses_kernels.h"

namespace toile {

/// Inverses of symmetric positive definite matrices of different sizes on a GPU, all at once, in double
/// precision.
class BatchedInverses {
public:
    /// @param space  borrowed
    /// @param sizes  [matrices] rows of each
    /// @throws DeviceError if there are 2^31 entries or more, or too little memory
    BatchedInverses(const CudaSpace& space, const std::vector<int>& sizes);

    /// Entries to be filled, zero where padded, and the inverses in single precision.
    MatrixBatch view();
    const std::vector<MatrixBatch::Matrix>& matrices() const { return matrices_on_host_; }
    DeviceArray<double>& entries() { return entries_; }
    const DeviceArray<float>& inverses() const { return inverses_; }

    /// Inverts the matrices whose entries were filled, which are lost. Rows that depend on others, with a
    /// pivot below a millionth of their diagonal, and rows without entries are left out: zero in the inverse.
    /// Enqueued.
    void invert();

private:
    const CudaSpace& space_;
    std::vector<MatrixBatch::Matrix> matrices_on_host_;
    DeviceArray<MatrixBatch::Matrix> matrices_;
    DeviceArray<MatrixTile> tile_rows_, tile_pairs_;
    std::vector<int> tile_row_counts_,
        tile_pair_counts_; ///< [k] of the matrices with more than k tiles a row
    DeviceArray<double> entries_, scales_, products_, columns_;
    DeviceArray<float> inverses_;
};

} // namespace toile
