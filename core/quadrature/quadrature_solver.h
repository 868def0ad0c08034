#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"
#include "core/quadrature/kernel_table.h"

namespace toile {

/// H^-1 by kernel-side quadrature: the paper's near and far fields, with the kernel sampled and the
/// right-hand side aggregated. Not exact and not symmetric; how far x += solve(b - H x) contracts is measured
/// in docs/core/quadrature.md.
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

    const KernelTable& table() const { return tables_->kernel; } ///< after update() with a free node

private:
    using Vec3f = Eigen::Vector3f;

    /// What update() makes; the basis borrows the tree.
    struct Tables {
        ClusterTree tree;
        ClusterBasis basis;
        KernelTable kernel;

        Tables(View<const Place> places, std::vector<int> nodes)
            : tree(places, std::move(nodes)), basis(tree, places)
        {
        }
    };

    void apply(View<const Vec3> b, View<Vec3> x) const;
    void gather_moments(View<const Vec3> b, View<Vec3f> moments) const;

    std::vector<Place> places_;
    Settings settings_;
    std::unique_ptr<Tables> tables_; ///< null while nothing is free
};

} // namespace toile
