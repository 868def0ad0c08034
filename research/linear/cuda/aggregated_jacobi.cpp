#include "research/linear/cuda/aggregated_jacobi.h"

namespace toile::research {

void DeviceAggregatedJacobi::prepare(const SparseMatrix& A, const std::vector<double>& inverse_diagonal)
{
    const AggregatedSweeps sweeps(A, inverse_diagonal, settings_);
    before_.set(A, inverse_diagonal, sweeps.before);

    // R^l x + c - x = c - (I - R^l) x: sweeps with another matrix, unscaled.
    SparseMatrix step(A.rows(), A.cols());
    step.setIdentity();
    step -= sweeps.R;
    step.makeCompressed();
    std::vector<double> is_free(inverse_diagonal.size());
    for (size_t i = 0; i < is_free.size(); ++i)
        is_free[i] = inverse_diagonal[i] == 0.0 ? 0.0 : 1.0;
    aggregated_.set(step, is_free, sweeps.steps);
    c_.resize(int(is_free.size()));
}

void DeviceAggregatedJacobi::solve_free(View<const PaddedVec3> b, View<PaddedVec3> x) const
{
    before_.solve(b, c_.view());
    aggregated_.solve(c_.view(), x);
}

} // namespace toile::research
