#include "research/linear/cuda/padded_solver.h"

#include "core/compute/cuda/parallel.cuh"
#include "core/pd/preconditioner/padded_solver.h"
#include "research/linear/jacobi_kernels.h"

namespace toile::research {

DevicePaddedSolver::DevicePaddedSolver(const CudaSpace& space)
    : DeviceSolver(space), is_free_(space, "baselines/is_free"), b_(space, "baselines/b"),
      x_(space, "baselines/x")
{
}

void DevicePaddedSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    TOILE_ASSERT(H.rows() == fixed.size());
    std::vector<float> is_free(fixed.size());
    for (int i = 0; i < fixed.size(); ++i)
        is_free[i] = fixed[i] ? 0.0F : 1.0F;
    is_free_.upload(is_free);
    b_.resize(fixed.size());
    x_.resize(fixed.size());
    const SparseMatrix A = without_zeros(H);
    prepare(A, invert_diagonal(A, fixed));
}

void DevicePaddedSolver::solve_on_device(View<const Vec3> b, View<Vec3> x) const
{
    parallel_for(space(), "baselines/pad", b.size(), PadFree{b, is_free_.view(), b_.view()});
    solve_free(b_.view(), x_.view());
    parallel_for(space(), "baselines/unpad", b.size(), UnpadFree{x_.view(), b, is_free_.view(), x});
}

} // namespace toile::research
