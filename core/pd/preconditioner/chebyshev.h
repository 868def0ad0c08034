#pragma once

#include <vector>

#include "core/pd/preconditioner/padded_solver.h"
#include "core/pd/preconditioner/spectrum.h"

namespace toile {

/// One step of the Chebyshev semi-iteration: d = momentum d + gain M^-1 (b - A x), x += d.
struct ChebyshevStep {
    double momentum = 0.0; ///< [-]
    double gain = 1.0;     ///< [-]
};

/// Steps with the smallest worst-case error for eigenvalues of M^-1 A inside the bounds [Golub & Varga 1961;
/// Saad 2003, alg. 12.1]: errors there shrink by chebyshev_contraction() or more. Errors below the lower
/// bound shrink less; above the upper bound they grow.
/// @param count  at least 1
std::vector<ChebyshevStep> chebyshev_steps(const SpectralBounds& bounds, int count);

/// 1 / T_count((highest + lowest) / (highest - lowest)) [-]      [Golub & Varga 1961]
double chebyshev_contraction(const SpectralBounds& bounds, int count);

/// Chebyshev with M = D = diag(A) on padded fields, one pass over A per step: a solver with many steps, a
/// smoother with few. Its polynomial in D^-1 A is fixed. It is therefore linear in b and, from zero,
/// symmetric.
class ChebyshevJacobi {
public:
    ChebyshevJacobi() = default;

    /// @param A                 [n x n] compressed
    /// @param inverse_diagonal  [n] 1 / a_ii; 0 excludes the row
    ChebyshevJacobi(const SparseMatrix& A, std::vector<double> inverse_diagonal,
                    std::vector<ChebyshevStep> steps);

    /// Computes x by the steps from zero: one product with A fewer than steps.
    void solve(View<const Vec4> b, View<Vec4> x) const;

    /// Applies the steps to x, in place.
    void improve(View<const Vec4> b, View<Vec4> x) const;

    /// Computes r = b - A x; zero at excluded rows if b and x are.
    void residual(View<const Vec4> b, View<const Vec4> x, View<Vec4> r) const;

    const SparseMatrix& matrix() const { return A_; }
    int size() const { return int(inverse_diagonal_.size()); }

private:
    void sweep(const ChebyshevStep& step, View<const Vec4> b, View<const Vec4> x, View<Vec4> next) const;

    SparseMatrix A_;
    std::vector<double> inverse_diagonal_;
    std::vector<ChebyshevStep> steps_;
    mutable std::vector<Vec4> d_, other_; ///< last change of x; output of every other step
};

} // namespace toile
