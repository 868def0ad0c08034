#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"

namespace toile {

/// Exact: the Cholesky factor of H. The ordering is kept while the pattern stays.
class DirectSolver : public GlobalSolver {
public:
    void update(const SparseMatrix& H, View<const unsigned char>) override
    {
        if (cholesky_ && has_pattern_of(H)) {
            cholesky_->refactor(H);
            return;
        }
        cholesky_.emplace(H);
        first_.assign(H.outerIndexPtr(), H.outerIndexPtr() + H.outerSize() + 1);
        columns_.assign(H.innerIndexPtr(), H.innerIndexPtr() + H.nonZeros());
    }
    void solve(View<const Vec3> b, View<Vec3> x) const override { cholesky_->solve(b, x); }
    bool is_symmetric() const override { return true; }

    const Cholesky& cholesky() const { return *cholesky_; } ///< after update()

private:
    bool has_pattern_of(const SparseMatrix& H) const
    {
        return std::equal(first_.begin(), first_.end(), H.outerIndexPtr(),
                          H.outerIndexPtr() + H.outerSize() + 1) &&
               std::equal(columns_.begin(), columns_.end(), H.innerIndexPtr(),
                          H.innerIndexPtr() + H.nonZeros());
    }

    std::optional<Cholesky> cholesky_;
    std::vector<int> first_, columns_; ///< the pattern it was ordered for
};

} // namespace toile
