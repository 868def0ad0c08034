#pragma once

#include <memory>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/tables/table_store.h"

namespace toile {

/// H^-1 by kernel-side quadrature: the paper's near and far fields, with the kernel sampled and the
/// right-hand side aggregated. Neither exact nor symmetric; docs/journal/quadrature.md has the measured
/// contraction of x += solve(b - H x).
class QuadratureSolver : public GlobalSolver {
public:
    using Settings = QuadratureTables::Settings;

    /// @param points    [n] embedded points of the nodes
    /// @param store     source of the tables
    /// @param listener  called while update() prepares tables
    explicit QuadratureSolver(std::vector<EmbeddedPoint> points, Settings settings = Settings{},
                              std::shared_ptr<TableStore> store = TableStore::of_process(),
                              TableListener listener = {});

    /// Gets the tables of H from the store, which may build them: seconds for 10 000 nodes.
    /// @throws Cancelled if the listener cancels; the solver then keeps its state
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override { operator_.solve(b, x); }
    bool is_symmetric() const override { return false; }

    const KernelTable& table() const { return operator_.tables().kernel; } ///< after update()

private:
    std::vector<EmbeddedPoint> points_;
    Settings settings_;
    std::shared_ptr<TableStore> store_;
    TableListener listener_;
    QuadratureOperator operator_;
};

} // namespace toile
