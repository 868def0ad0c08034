#pragma once

#include <memory>
#include <utility>

#include "core/quadrature/quadrature_tables.h"

namespace toile {

/// Applies finished tables: x = H^-1 b, nearly. Two passes: moments of b up the cluster tree, then a sum over
/// each target's lists. O(n log n) numbers are read. Fixed nodes are left out of both: their kernel rows are
/// the identity's.
class QuadratureOperator {
public:
    QuadratureOperator() = default; ///< without tables: only to be assigned to
    explicit QuadratureOperator(std::shared_ptr<const QuadratureTables> tables) : tables_(std::move(tables))
    {
    }

    const QuadratureTables& tables() const { return *tables_; }

    /// As GlobalSolver::solve(). Safe to call from several threads.
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
