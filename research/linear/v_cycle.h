#pragma once

#include <vector>

#include "core/pd/preconditioner/chebyshev.h"
#include "research/linear/dense_inverse.h"

namespace toile::research {

/// Chebyshev smoothing of a V-cycle, on the upper part of the spectrum, which the coarse space does not reach
/// [Adams et al. 2003].
struct SmootherSettings {
    int degree = 2;         ///< sweeps before, and as many after, the coarse correction
    double ratio = 8.0;     ///< [-] highest eigenvalue over the lowest one that is smoothed
    int lanczos_steps = 15; ///< for the highest eigenvalue; see estimate_bounds()
};

/// One multigrid V-cycle from zero: smooth, correct from the next coarser level, smooth again [Briggs et al.
/// 2000, chapter 3]. Both smoothings are the same polynomial in D^-1 A and the coarse matrices are P^T A P,
/// so that the cycle is symmetric positive definite.
class VCycle {
public:
    /// Adds the next coarser level and returns its Galerkin matrix P^T A P.
    /// @param A        [n x n] the finest matrix, or the last one returned
    /// @param highest  upper bound of the eigenvalues of D^-1 A
    /// @param P        [n x coarse] empty rows for vertices left to the smoother or alone
    SparseMatrix add_level(const SparseMatrix& A, std::vector<double> inverse_diagonal, double highest,
                           const SparseMatrix& P, const SmootherSettings& settings);

    /// Ends the hierarchy.
    /// @throws InvalidInput if A is not positive definite
    void end(const SparseMatrix& A);

    void solve(View<const Vec4> b, View<Vec4> x) const { solve(0, b, x); }

    /// Rows of each level's matrix, finest first.
    std::vector<int> sizes() const;

private:
    struct Level {
        ChebyshevJacobi smoother;
        SparseMatrix P, P_transposed;
        mutable std::vector<Vec4> r, coarse_b, coarse_x;
    };

    void solve(size_t level, View<const Vec4> b, View<Vec4> x) const;

    std::vector<Level> levels_;
    DenseInverse coarsest_;
};

} // namespace toile::research
