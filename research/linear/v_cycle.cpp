#include "research/linear/v_cycle.h"

#include <utility>

#include "core/compute/parallel.h"

namespace toile::research {

SparseMatrix VCycle::add_level(const SparseMatrix& A, std::vector<double> inverse_diagonal, double highest,
                               const SparseMatrix& P, const SmootherSettings& settings)
{
    const SparseMatrix P_transposed = P.transpose();
    const SparseMatrix AP = A * P;
    SparseMatrix coarse = P_transposed * AP;
    coarse.makeCompressed();

    Level level;
    level.r.resize(A.rows());
    level.coarse_b.resize(P.cols());
    level.coarse_x.resize(P.cols());
    level.P = P;
    level.P_transposed = P_transposed;
    level.smoother = ChebyshevJacobi(A, std::move(inverse_diagonal),
                                     chebyshev_steps({highest / settings.ratio, highest}, settings.degree));
    levels_.push_back(std::move(level));
    return coarse;
}

void VCycle::end(const SparseMatrix& A) { coarsest_ = DenseInverse(A); }

std::vector<int> VCycle::sizes() const
{
    std::vector<int> sizes;
    for (const Level& level : levels_)
        sizes.push_back(level.smoother.size());
    sizes.push_back(coarsest_.size());
    return sizes;
}

void VCycle::solve(size_t index, View<const Vec4> b, View<Vec4> x) const
{
    if (index == levels_.size()) {
        coarsest_.solve(b, x);
        return;
    }
    const Level& level = levels_[index];
    const View<Vec4> r = level.r, coarse_b = level.coarse_b, coarse_x = level.coarse_x;
    level.smoother.solve(b, x);

    // x += P (P^T A P)^-1 P^T (b - A x), approximately.
    level.smoother.residual(b, x, r);
    parallel_for(kCpu, "baselines/restrict", coarse_b.size(),
                 [&](int i) { coarse_b[i] = row_times(level.P_transposed, i, View<const Vec4>(r)); });
    solve(index + 1, coarse_b, coarse_x);
    parallel_for(kCpu, "baselines/prolong", x.size(),
                 [&](int i) { x[i] += row_times(level.P, i, View<const Vec4>(coarse_x)); });

    level.smoother.improve(b, x);
}

} // namespace toile::research
