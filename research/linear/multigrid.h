#pragma once

#include "research/linear/v_cycle.h"

namespace toile::research {

/// Smoothed aggregation algebraic multigrid [Vanek, Mandel, Brezina 1996]: one V-cycle. Coarse functions are
/// sums over groups of vertices, smoothed by one Jacobi step against A. The groups follow the strong entries
/// of A, so that it serves any sewn surface and needs no grid.
///
/// O(n) to apply, with 2 degree + 2 dependent loops a level; setup serial. Linear in b, symmetric positive
/// definite.
class Multigrid final : public PaddedSolver {
public:
    struct Settings {
        SmootherSettings smoother;

        /// Entries |a_ij| up to strength sqrt(a_ii a_jj) are weak: they form no groups [Vanek et al. 1996].
        /// Halved from level to level.
        double strength = 0.08; ///< [-]

        int coarsest_size = 300; ///< max rows of a level that is solved by its dense inverse
    };

    Multigrid() : Multigrid(Settings{}) {}
    explicit Multigrid(const Settings& settings) : settings_(settings) {}

    bool is_symmetric() const override { return true; }

    /// Rows of each level's matrix, finest first; after update().
    std::vector<int> level_sizes() const { return cycle_.sizes(); }

private:
    void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) override;
    void solve_free(View<const Vec4> b, View<Vec4> x) const override { cycle_.solve(b, x); }

    Settings settings_;
    VCycle cycle_;
};

} // namespace toile::research
