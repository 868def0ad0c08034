#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/compute/lanes.h"
#include "core/linear/cuda/solver.h"

namespace toile::research {

/// Base of the baselines on a GPU, the counterpart of PaddedSolver. Fields are in single precision, as in
/// solvers that others correct. At fixed vertices b is copied bit for bit.
class DevicePaddedSolver : public DeviceSolver {
public:
    /// @param space  borrowed
    explicit DevicePaddedSolver(const CudaSpace& space);

    void update(const SparseMatrix& H, View<const unsigned char> fixed) final;
    void solve_on_device(View<const Vec3> b, View<Vec3> x) const final;

protected:
    /// @param A                 [n x n] H, compressed, without explicit zeros
    /// @param inverse_diagonal  [n] 0 where fixed
    virtual void prepare(const SparseMatrix& A, const std::vector<double>& inverse_diagonal) = 0;

    /// Enqueues x = A^-1 b or close to it; b is zero at fixed vertices.
    virtual void solve_free(View<const PaddedVec3> b, View<PaddedVec3> x) const = 0;

private:
    DeviceArray<float> is_free_; ///< 0 where fixed
    mutable DeviceArray<PaddedVec3> b_, x_;
};

} // namespace toile::research
