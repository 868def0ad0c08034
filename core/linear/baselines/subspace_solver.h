#pragma once

#include "core/linear/baselines/v_cycle.h"

namespace toile {

/// A subspace of smooth functions solved directly, with Chebyshev smoothing before and after: the two-level
/// idea behind subspace-preconditioned Projective Dynamics for cloth, where a subspace takes care of low
/// frequencies and GPU iterations of high ones [Lan et al. 2024, "subspace reuse"; Li et al. 2023].
///
/// Not either paper's basis: our functions come from H alone, so that any sewn surface serves. They are bumps
/// around farthest-point samples that add up to 1 (coarse_functions.h), each smoothed by a Jacobi step
/// against H; H is projected to them (Galerkin) and inverted through its dense Cholesky factor.
///
/// O(n degree + functions^2) to apply. What lies between two functions is the smoother's, so that its
/// interval grows with n / functions and the degree must grow with the square root of that for the same rate.
/// Linear in b, symmetric positive definite.
class SubspaceSolver final : public PaddedSolver {
public:
    struct Settings {
        int functions = 300;        ///< at most
        int degree = 4;             ///< Chebyshev sweeps before, and as many after, the subspace
        double overlap = 2.0;       ///< [-] reach of a bump; see partition_of_unity()
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

} // namespace toile
