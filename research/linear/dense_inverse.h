#pragma once

#include <Eigen/Dense>

#include "core/pd/preconditioner/padded_solver.h"

namespace toile::research {

/// Inverse of a small symmetric positive definite matrix, through its Cholesky factor, for coarsest levels. A
/// product with it runs in parallel, which two triangular solves do not. O(n^3) to build, O(n^2) to apply.
class DenseInverse {
public:
    DenseInverse() = default;

    /// @throws InvalidInput if A is not positive definite
    explicit DenseInverse(const SparseMatrix& A);

    /// x = A^-1 b.
    /// @param b, x  [n], different arrays
    void solve(View<const Vec4> b, View<Vec4> x) const;

    int size() const { return int(inverse_.rows()); }

private:
    Eigen::MatrixXd inverse_; ///< [n x n] symmetric to the last bit
};

} // namespace toile::research
