#pragma once

#include "core/linear/sparse_matrix.h"

namespace toile {

/// Interval of the eigenvalues of D^-1 A, D = diag(A) [-]; always contains 1.
struct SpectralBounds {
    double lowest = 1.0;
    double highest = 1.0;
};

/// Factor on the highest Ritz value [-]. An upper end one or two percent too low makes Chebyshev diverge
/// (measured on cloth, 5k vertices); after about ten steps the highest Ritz value is that close.
inline constexpr double kMaxMargin = 1.05;

/// Factor on the lowest Ritz value [-], which lies above the lowest eigenvalue. A lower end that is too high
/// only slows the convergence of the smoothest errors.
inline constexpr double kMinMargin = 0.9;

/// Ritz values of D^-1/2 A D^-1/2 after Lanczos with full reorthogonalisation [Golub & Van Loan 2013, section
/// 10.1], with margins. The upper end is limited by Gershgorin's max_i sum_j |a_ij| / a_ii, which is
/// rigorous. Starts near the constant field: cloth's lowest mode is close to it, so both ends converge early.
/// O(steps nnz + steps^2 n), serial.
/// @param inverse_diagonal  [n] 1 / a_ii, or 0 to exclude row and column
/// @throws InvalidInput if a Ritz value shows that A is not positive definite
SpectralBounds estimate_bounds(const SparseMatrix& A, View<const double> inverse_diagonal, int lanczos_steps);

} // namespace toile
