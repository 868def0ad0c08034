#include "core/linear/cuda/solver.h"

namespace toile {

DeviceSolver::DeviceSolver(const CudaSpace& space)
    : space_(space), b_(space, "solver/b"), x_(space, "solver/x")
{
}

void DeviceSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    b_.upload(b);
    x_.resize(x.size());
    solve_on_device(b_.view(), x_.view());
    x_.download(x);
    space_.synchronise();
}

} // namespace toile
