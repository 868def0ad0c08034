#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/compute/lanes.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/preconditioner/chebyshev.h"

namespace toile::research {

/// ChebyshevJacobi on a GPU, in single precision: one kernel per sweep.
class DeviceSweeps {
public:
    explicit DeviceSweeps(const CudaSpace& space);

    /// @param A      [n x n] compressed
    /// @param scale  [n] factor of residuals, 1 / a_ii or other; 0 at rows to leave alone
    /// @param steps  at least 1
    void set(const SparseMatrix& A, View<const double> scale, std::vector<ChebyshevStep> steps);

    /// Enqueues x = result of the steps from zero.
    /// @param b, x  [n] not the same array
    void solve(View<const PaddedVec3> b, View<PaddedVec3> x);

private:
    const CudaSpace& space_;
    std::vector<ChebyshevStep> steps_;
    DeviceArray<int> first_; ///< of SlicedRows
    DeviceArray<RowEntry> entries_;
    DeviceArray<float> scale_;
    DeviceArray<PaddedVec3> d_, other_;
};

} // namespace toile::research
