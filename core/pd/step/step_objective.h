#pragma once

#include <optional>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/energy/objective.h"
#include "core/pd/preconditioner/nested_pcg.h"
#include "core/pd/step/step_hessian.h"
#include "core/pd/step/step_stop.h"

namespace toile {

/// Objective of one step: inertia, the system's energies, and an energy with an active set.
class StepObjective : public Objective {
public:
    /// @param start   borrowed fields
    /// @param active  may be null: then the inverse is one direct solve and PCG never runs
    StepObjective(const System& system, const StepStart& start, ActiveSetEnergy* active,
                  const NestedPcg::Settings& contact_solve = {}, StepStop stop = StepStop::Error);

    double evaluate(View<const Vec3> x, View<Vec3> gradient) override;
    void precondition(View<const Vec3> g, View<Vec3> z) override;
    void precondition_linearly(View<const Vec3> g, View<Vec3> z) override { system_.solver().solve(g, z); }
    void accept(View<const Vec3> x) override;
    Hessian* hessian() override;
    bool is_minimiser(View<const Vec3> gradient, View<const Vec3> move, double tolerance) const override;
    double negligible_gain(double tolerance) const override;

    int linear_iterations() const { return linear_iterations_; }

private:
    NestedPcg& pcg();

    const System& system_;
    StepStart start_;
    ActiveSetEnergy* active_;
    NestedPcg::Settings contact_solve_;
    StepStop stop_;
    std::optional<NestedPcg> pcg_;    ///< none before the active set is first active
    std::vector<double> own_inertia_; ///< [vertices] [N/m] if the start has none
    View<const double> inertia_;      ///< [vertices] [N/m]
    double free_mass_ = 0.0;          ///< [kg] of the free vertices
    bool has_active_set_ = false;
    bool is_pcg_current_ = false; ///< pcg_ has the active set as last frozen
    int linear_iterations_ = 0;
    std::optional<StepHessian> hessian_;
};

} // namespace toile
