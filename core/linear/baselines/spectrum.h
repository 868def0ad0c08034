#pragma once

#include "core/linear/sparse_matrix.h"

namespace toile {

/// An interval for the eigenvalues of D^-1 A, D = diag(A) [-]; 1 is always inside.
struct SpectralBounds {
    double lowest = 1.0;
    double highest = 1.0;
};

/// What the highest Ritz value is raised by. An upper end one or two percent too low makes Chebyshev diverge
/// (measured on cloth, 5k vertices); the highest Ritz value is that close after some ten steps.
inline constexpr double kHighestMargin = 1.05;

/// What the lowest Ritz value is lowered by; it lies above the lowest eigenvalue, and an end too high only
/// slows the smoothest errors down.
inline constexpr double kLowestMargin = 0.9;

/// Ritz values of D^-1/2 A D^-1/2 after Lanczos with full reorthogonalisation [Golub & Van Loan 2013, section
/// 10.1] with margins; the upper end no higher than Gershgorin's max_i sum_j |a_ij| / a_ii, which is
/// rigorous. Starts near the constant field: cloth's lowest mode is close to it, so that both ends come
/// early. O(steps nnz + steps^2 n), serial.
/// @param inverse_diagonal  [n] 1 / a_ii, or 0 where row and column are to be left out
/// @throws InvalidInput when a Ritz value shows that A is not positive definite
SpectralBounds estimate_bounds(const SparseMatrix& A, View<const double> inverse_diagonal, int lanczos_steps);

} // namespace toile
