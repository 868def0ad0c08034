#include "research/linear/cuda/chebyshev_solver.h"

namespace toile::research {

void DeviceChebyshevSolver::prepare(const SparseMatrix& A, const std::vector<double>& inverse_diagonal)
{
    const SpectralBounds bounds = estimate_bounds(A, inverse_diagonal, settings_.lanczos_steps);
    sweeps_.set(A, inverse_diagonal, chebyshev_steps(bounds, settings_.sweeps));
}

} // namespace toile::research
