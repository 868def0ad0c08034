#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"

namespace toile {

/// Exact global solver: the Cholesky factor of H. The ordering is kept while the pattern stays. Equal H of
/// other solvers in the process are factored once (shared_factor.h).
class DirectSolver : public GlobalSolver {
public:
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return true; }

    /// Factor of the last H; null before update().
    const std::shared_ptr<const SupernodalFactor>& factor() const { return factor_; }

private:
    bool has_pattern_of(const SparseMatrix& H) const;

    std::shared_ptr<const SupernodalFactor> factor_;
    std::optional<Cholesky> cholesky_; ///< none while all factors came from other solvers
    std::vector<int> first_, columns_; ///< pattern for which cholesky_ was ordered
};

} // namespace toile
