#include "research/linear/cuda/sweeps.h"

#include <utility>

#include "core/compute/cuda/teams.cuh"
#include "research/linear/jacobi_kernels.h"

namespace toile::research {

DeviceSweeps::DeviceSweeps(const CudaSpace& space)
    : space_(space), first_(space, "sweeps/first"), entries_(space, "sweeps/entries"),
      scale_(space, "sweeps/scale"), d_(space, "sweeps/d"), other_(space, "sweeps/other")
{
}

void DeviceSweeps::set(const SparseMatrix& A, View<const double> scale, std::vector<ChebyshevStep> steps)
{
    TOILE_ASSERT(!steps.empty());
    steps_ = std::move(steps);
    const SlicedRows rows = sliced_rows_of(A);
    first_.upload(rows.first);
    entries_.upload(rows.entries);
    scale_.upload(std::vector<float>(scale.begin(), scale.end()));
    d_.resize(scale.size());
    other_.resize(scale.size());
}

void DeviceSweeps::solve(View<const PaddedVec3> b, View<PaddedVec3> x)
{
    // The last step has to end in x.
    View<PaddedVec3> from = x, to = other_.view();
    if (steps_.size() % 2 == 0)
        std::swap(from, to);
    parallel_for(space_, "baselines/first_sweep", b.size(),
                 FirstSweep{float(steps_[0].gain), scale_.view(), b, d_.view(), from});
    for (size_t k = 1; k < steps_.size(); ++k) {
        parallel_for_teams<SlicedRows::kThreads>(space_, "baselines/sweep", b.size(),
                                                 SweepRow{first_.view(), entries_.view(),
                                                          float(steps_[k].momentum), float(steps_[k].gain),
                                                          scale_.view(), b, from, d_.view(), to});
        std::swap(from, to);
    }
}

} // namespace toile::research
