#pragma once

#include "research/linear/chebyshev_solver.h"
#include "research/linear/cuda/padded_solver.h"
#include "research/linear/cuda/sweeps.h"

namespace toile::research {

/// ChebyshevSolver on a GPU [Wang 2015]: the CPU's sweeps in single precision.
class DeviceChebyshevSolver final : public DevicePaddedSolver {
public:
    using Settings = ChebyshevSolver::Settings;

    explicit DeviceChebyshevSolver(const CudaSpace& space, const Settings& settings = {})
        : DevicePaddedSolver(space), settings_(settings), sweeps_(space)
    {
    }

private:
    void prepare(const SparseMatrix& A, const std::vector<double>& inverse_diagonal) override;
    void solve_free(View<const PaddedVec3> b, View<PaddedVec3> x) const override { sweeps_.solve(b, x); }

    Settings settings_;
    mutable DeviceSweeps sweeps_;
};

} // namespace toile::research
