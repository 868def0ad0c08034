#include "core/pd/preconditioner/padded_solver.h"

#include <string>

#include "core/base/error.h"
#include "core/linear/field.h"

namespace toile {

std::vector<double> invert_diagonal(const SparseMatrix& A, View<const unsigned char> fixed)
{
    std::vector<double> inverse(A.rows(), 0.0);
    for (int i = 0; i < int(A.rows()); ++i) {
        const double diagonal = A.coeff(i, i);
        if (!(diagonal > 0.0))
            throw InvalidInput("matrix is not positive definite (row " + std::to_string(i) + "): diagonal " +
                               std::to_string(diagonal));
        if (!fixed[i])
            inverse[i] = 1.0 / diagonal;
    }
    return inverse;
}

SparseMatrix without_zeros(const SparseMatrix& H)
{
    SparseMatrix A = H.pruned(0.0, 0.0);
    A.makeCompressed();
    return A;
}

void PaddedSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    TOILE_ASSERT(H.rows() == fixed.size());
    fixed_.assign(fixed.begin(), fixed.end());
    b_.resize(fixed.size());
    x_.resize(fixed.size());
    const SparseMatrix A = without_zeros(H);
    prepare(A, invert_diagonal(A, fixed));
}

void PaddedSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    parallel_for(
        kCpu, "baselines/pad", b.size(),
        [&](int i) {
            if (fixed_[i])
                b_[i].setZero();
            else
                b_[i] << b[i], 0.0;
        },
        kFieldGrain);
    solve_free(b_, x_);
    parallel_for(
        kCpu, "baselines/unpad", b.size(),
        [&](int i) {
            if (fixed_[i])
                x[i] = b[i];
            else
                x[i] = x_[i].head<3>();
        },
        kFieldGrain);
}

} // namespace toile
