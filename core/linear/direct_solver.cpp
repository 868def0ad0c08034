#include "core/linear/direct_solver.h"

#include <algorithm>

#include "core/base/stages.h"
#include "core/linear/shared_factor.h"

namespace toile {

void DirectSolver::update(const SparseMatrix& H, View<const unsigned char>)
{
    factor_ = shared_factor(H, [&] {
        if (cholesky_ && has_pattern_of(H)) {
            cholesky_->refactor(H);
        } else {
            cholesky_.emplace(H);
            first_.assign(H.outerIndexPtr(), H.outerIndexPtr() + H.outerSize() + 1);
            columns_.assign(H.innerIndexPtr(), H.innerIndexPtr() + H.nonZeros());
        }
        return cholesky_->shared_factor();
    });
}

void DirectSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    const StageScope stage("linear/solve");
    factor_->solve(b, x);
}

bool DirectSolver::has_pattern_of(const SparseMatrix& H) const
{
    return std::equal(first_.begin(), first_.end(), H.outerIndexPtr(),
                      H.outerIndexPtr() + H.outerSize() + 1) &&
           std::equal(columns_.begin(), columns_.end(), H.innerIndexPtr(), H.innerIndexPtr() + H.nonZeros());
}

} // namespace toile
