#pragma once

#include <optional>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"

namespace toile {

/// Exact: the Cholesky factor of H. The ordering is kept while the pattern stays.
class DirectSolver : public GlobalSolver {
public:
    void update(const SparseMatrix& H, View<const unsigned char>) override
    {
        if (cholesky_ && cholesky_->size() == H.rows())
            cholesky_->refactor(H);
        else
            cholesky_.emplace(H);
    }
    void solve(View<const Vec3> b, View<Vec3> x) const override { cholesky_->solve(b, x); }
    bool is_symmetric() const override { return true; }

    const Cholesky& cholesky() const { return *cholesky_; } ///< after update()

private:
    std::optional<Cholesky> cholesky_;
};

} // namespace toile
