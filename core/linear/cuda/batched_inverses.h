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
    BatchedInverses(const CudaSpace& space, const std::vector<int>& sizes);

    /// Entries to be filled, and the inverses.
    MatrixBatch view();
    const std::vector<MatrixBatch::Matrix>& matrices() const { return matrices_on_host_; }
    DeviceArray<double>& entries() { return entries_; }
    const DeviceArray<float>& inverses() const { return inverses_; }

    /// Inverts the matrices whose entries were filled, which are lost. Rows that depend on others, and rows
    /// without entries, are left out: zero in the inverse. Enqueued.
    void invert();

private:
    const CudaSpace& space_;
    std::vector<MatrixBatch::Matrix> matrices_on_host_;
    DeviceArray<MatrixBatch::Matrix> matrices_;
    DeviceArray<MatrixTile> tile_rows_, tile_pairs_;
    std::vector<int> tile_rows_from_, tile_pairs_from_; ///< [k] tiles of matrices with more than k a row
    DeviceArray<double> entries_, scales_, products_, columns_;
    DeviceArray<float> inverses_;
};

} // namespace toile
