#pragma once

#include "research/linear/aggregated_jacobi.h"
#include "research/linear/cuda/padded_solver.h"
#include "research/linear/cuda/sweeps.h"

namespace toile::research {

/// AggregatedJacobi on a GPU, for which it was made [Lan et al. 2022]: the CPU's sweeps in single precision.
class DeviceAggregatedJacobi final : public DevicePaddedSolver {
public:
    using Settings = AggregatedSweeps::Settings;

    explicit DeviceAggregatedJacobi(const CudaSpace& space, const Settings& settings = {})
        : DevicePaddedSolver(space), settings_(settings), before_(space), aggregated_(space),
          c_(space, "a_jacobi/c")
    {
    }

private:
    void prepare(const SparseMatrix& A, const std::vector<double>& inverse_diagonal) override;
    void solve_free(View<const PaddedVec3> b, View<PaddedVec3> x) const override;

    Settings settings_;
    mutable DeviceSweeps before_, aggregated_;
    mutable DeviceArray<PaddedVec3> c_;
};

} // namespace toile::research
