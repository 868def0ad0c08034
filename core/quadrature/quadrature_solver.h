#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/quadrature/quadrature_operator.h"

namespace toile {

/// H^-1 by kernel-side quadrature: the paper's near and far fields, with the kernel sampled and the
/// right-hand side aggregated. Not exact and not symmetric; how far x += solve(b - H x) contracts is measured
/// in docs/core/quadrature.md.
class QuadratureSolver : public GlobalSolver {
public:
    using Settings = QuadratureTables::Settings;

    /// @param places  [n] where the nodes are
    explicit QuadratureSolver(std::vector<Place> places, Settings settings = Settings{})
        : places_(std::move(places)), settings_(settings)
    {
    }

    void update(const SparseMatrix& H, View<const unsigned char> fixed) override
    {
        operator_ = QuadratureOperator(build_tables({H, fixed, places_, settings_}, nullptr));
    }
    void solve(View<const Vec3> b, View<Vec3> x) const override { operator_.solve(b, x); }
    bool is_symmetric() const override { return false; }

    const KernelTable& table() const { return operator_.tables().kernel; } ///< after update()

private:
    std::vector<Place> places_;
    Settings settings_;
    QuadratureOperator operator_;
};

} // namespace toile
