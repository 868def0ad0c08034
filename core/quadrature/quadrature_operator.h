#pragma once

#include <memory>
#include <utility>

#include "core/quadrature/tables/quadrature_tables.h"

namespace toile {

/// Approximate x = H^-1 b with finished tables. Two passes: an upward pass computes moments of b on the
/// cluster tree, then each target sums over its lists. Reads O(n log n) numbers. Both passes leave out fixed
/// nodes: their rows of the kernel are the identity's.
class QuadratureOperator {
public:
    QuadratureOperator() = default; ///< no tables; only for assignment
    explicit QuadratureOperator(std::shared_ptr<const QuadratureTables> tables) : tables_(std::move(tables))
    {
    }

    const QuadratureTables& tables() const { return *tables_; }

    /// See GlobalSolver::solve(). Safe to call from several threads.
    void solve(View<const Vec3> b, View<Vec3> x) const;

private:
    using Vec3f = Eigen::Vector3f;

    void apply(View<const Vec3> b, View<Vec3> x) const;
    template <int Rank>
    void gather(View<const Vec3f> sources, View<const Vec3f> moments, View<Vec3> x) const;
    void gather_moments(View<const Vec3> b, View<Vec3f> moments) const;

    std::shared_ptr<const QuadratureTables> tables_;
};

} // namespace toile
