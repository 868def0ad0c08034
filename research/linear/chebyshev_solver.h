#pragma once

#include "core/pd/preconditioner/chebyshev.h"

namespace toile::research {

/// Chebyshev semi-iteration on D^-1 H with a fixed number of sweeps. [Wang 2015, alg. 1] accelerates Jacobi's
/// global step of Projective Dynamics in this form; here it runs on H alone, with both ends of the spectrum.
///
/// Wang takes the spectrum of I - D^-1 H as [-rho, rho] and tunes rho by hand. He starts after some plain
/// sweeps and damps by 0.9 against nonlinear trouble. Here the ends come from Lanczos with margins
/// (spectrum.h). That also serves H with positive off-diagonals, where plain Jacobi diverges.
///
/// The error falls by chebyshev_contraction(bounds(), sweeps) or more in the norm of H. O(sweeps nnz), no
/// inner products: each sweep is one parallel loop. Linear in b, symmetric positive definite.
class ChebyshevSolver final : public PaddedSolver {
public:
    struct Settings {
        int sweeps = 32;        ///< products with H, plus one. At least 1.
        int lanczos_steps = 40; ///< in update(); see estimate_bounds()
    };

    ChebyshevSolver() : ChebyshevSolver(Settings{}) {}
    explicit ChebyshevSolver(const Settings& settings) : settings_(settings) {}

    bool is_symmetric() const override { return true; }

    /// Bounds of D^-1 H, after update().
    const SpectralBounds& bounds() const { return bounds_; }

private:
    void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) override;
    void solve_free(View<const Vec4> b, View<Vec4> x) const override { iteration_.solve(b, x); }

    Settings settings_;
    SpectralBounds bounds_;
    ChebyshevJacobi iteration_;
};

} // namespace toile::research
