#pragma once

#include "research/linear/v_cycle.h"

namespace toile::research {

/// Direct solve in a subspace of smooth functions, with Chebyshev smoothing before and after. This is the
/// two-level idea behind subspace-preconditioned Projective Dynamics for cloth: a subspace takes care of low
/// frequencies and GPU iterations of high ones [Lan et al. 2024, "subspace reuse"; Li et al. 2023].
///
/// The basis is not either paper's. Our functions come from H alone, so that they serve any sewn surface.
/// They are bumps around farthest-point samples that add up to 1 (coarse_functions.h), each smoothed by a
/// Jacobi step against H. H is projected to them (Galerkin) and inverted through its dense Cholesky factor.
///
/// O(n degree + functions^2) to apply. The smoother has to cover the scales below a function's width: its
/// interval grows with n / functions. For the same rate the degree must grow with the square root of that.
/// Linear in b, symmetric positive definite.
class SubspaceSolver final : public PaddedSolver {
public:
    struct Settings {
        int functions = 300;        ///< max number
        int degree = 4;             ///< Chebyshev sweeps before, and as many after, the subspace
        double overlap = 2.0;       ///< [-] relative reach of a bump; see partition_of_unity()
        int function_smoothing = 1; ///< Jacobi steps on the functions, in update()
    };

    SubspaceSolver() : SubspaceSolver(Settings{}) {}
    explicit SubspaceSolver(const Settings& settings) : settings_(settings) {}

    bool is_symmetric() const override { return true; }

private:
    void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) override;
    void solve_free(View<const Vec4> b, View<Vec4> x) const override { cycle_.solve(b, x); }

    Settings settings_;
    VCycle cycle_;
};

} // namespace toile::research
