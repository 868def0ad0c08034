#pragma once

#include <memory>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/table_store.h"

namespace toile {

/// H^-1 by kernel-side quadrature: the paper's near and far fields, with the kernel sampled and the
/// right-hand side aggregated. Not exact and not symmetric; how far x += solve(b - H x) contracts is measured
/// in docs/core/quadrature.md.
class QuadratureSolver : public GlobalSolver {
public:
    using Settings = QuadratureTables::Settings;

    /// @param places    [n] where the nodes are
    /// @param store     where tables come from
    /// @param listener  hears of tables that update() prepares
    explicit QuadratureSolver(std::vector<Place> places, Settings settings = Settings{},
                              std::shared_ptr<TableStore> store = TableStore::of_process(),
                              TableListener listener = {});

    /// Takes the tables of H from the store, which may have to build them: seconds for 10 000 nodes.
    /// @throws Cancelled where the listener wanted no more; the solver then stays as it was
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve(View<const Vec3> b, View<Vec3> x) const override { operator_.solve(b, x); }
    bool is_symmetric() const override { return false; }

    const KernelTable& table() const { return operator_.tables().kernel; } ///< after update()

private:
    std::vector<Place> places_;
    Settings settings_;
    std::shared_ptr<TableStore> store_;
    TableListener listener_;
    QuadratureOperator operator_;
};

} // namespace toile
