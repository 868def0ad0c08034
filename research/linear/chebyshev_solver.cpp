#include "research/linear/chebyshev_solver.h"

#include <utility>

namespace toile::research {

void ChebyshevSolver::prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal)
{
    bounds_ = estimate_bounds(A, inverse_diagonal, settings_.lanczos_steps);
    iteration_ = ChebyshevJacobi(A, std::move(inverse_diagonal), chebyshev_steps(bounds_, settings_.sweeps));
}

} // namespace toile::research
