#pragma once

#include <memory>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"
#include "core/quadrature/kernel_table.h"

namespace toile {

/// H^-1 by kernel-side quadrature: the paper's near and far fields, with the kernel sampled and the
/// right-hand side aggregated (docs/core/quadrature.md). Not exact and not symmetric; as an iteration x +=
/// solve(b - H x) it contracts by 0.2 to 0.35.
///
/// Two passes: moments of b up the cluster tree, then a sum over each target's lists. O(n log n) numbers are
/// read. Fixed nodes are left out of both: their kernel rows are the identity's.
class QuadratureSolver : public GlobalSolver {
public:
    using Settings = KernelTable::Settings;

    /// @param places  [n] where the nodes are
    explicit QuadratureSolver(std::vector<Place> places, Settings settings = Settings{});

    /// Factors H and tabulates its inverse. N solves: seconds for 10 000 nodes.
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return false; }

    const KernelTable& table() const { return table_; } ///< after update()

private:
    using Vec3f = Eigen::Vector3f;

    void gather_moments(View<const Vec3> b, View<Vec3f> moments) const;

    std::vector<Place> places_;
    Settings settings_;
    std::unique_ptr<ClusterTree> tree_;
    std::unique_ptr<ClusterBasis> basis_;
    KernelTable table_;
};

} // namespace toile
