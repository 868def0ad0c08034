#pragma once

#include "core/pd/preconditioner/padded_solver.h"

namespace toile::research {

/// Conjugate gradients preconditioned by D = diag(H), started at zero [Saad 2003, alg. 9.1]. x, y and z are
/// separate runs, side by side in the lanes of a register.
///
/// Not linear in b: step lengths depend on it. An outer conjugate gradient must use its flexible form, and
/// is_symmetric() says so. O(iterations nnz), two inner products an iteration.
class JacobiPcg final : public PaddedSolver {
public:
    /// Cloth whose stretch reaches 40 edges in a time step takes about 170 iterations to the default
    /// tolerance at 5k vertices (docs/journal/global_solvers.md); set the tolerance to 0 for a fixed count.
    struct Settings {
        double tolerance = 1e-2; ///< [-] of sqrt(r . D^-1 r) / sqrt(b . D^-1 b), each of x, y and z
        int max_iterations = 300;
    };

    JacobiPcg() : JacobiPcg(Settings{}) {}
    explicit JacobiPcg(const Settings& settings) : settings_(settings) {}

    bool is_symmetric() const override { return false; }

    /// Number of iterations of the last solve.
    int iterations() const { return iterations_; }

private:
    void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) override;
    void solve_free(View<const Vec4> b, View<Vec4> x) const override;

    Settings settings_;
    SparseMatrix A_;
    std::vector<double> inverse_diagonal_;
    mutable int iterations_ = 0;
    mutable std::vector<Vec4> r_, p_, product_;
};

} // namespace toile::research
