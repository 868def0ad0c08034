#include "core/pd/step/step_objective.h"

#include "core/linear/field.h"
#include "core/pd/step/step_error.h"
#include "core/pd/step/step_kernels.h"

namespace toile {

StepObjective::StepObjective(const System& system, const StepStart& start, ActiveSetEnergy* active,
                             const NestedPcg::Settings& contact_solve, StepStop stop)
    : system_(system), start_(start), active_(active), contact_solve_(contact_solve), stop_(stop)
{
    if (start.inertia.empty())
        for (const double mass : system.masses())
            own_inertia_.push_back(mass * (1.0 / (start.dt * start.dt)));
    inertia_ = start.inertia.empty() ? View<const double>(own_inertia_) : start.inertia;
    for (int i = 0; i < start.masses.size(); ++i)
        free_mass_ += start.fixed[i] ? 0.0 : start.masses[i];
}

double StepObjective::evaluate(View<const Vec3> x, View<Vec3> gradient)
{
    double value =
        parallel_sum(kCpu, x.size(), 0.0, InertiaOfVertex{inertia_, start_.prediction, x, gradient});
    value += system_.add_gradient(x, gradient);
    if (active_)
        value += active_->add_gradient(x, gradient);
    const View<const unsigned char> fixed = system_.fixed();
    for (int i = 0; i < x.size(); ++i)
        if (fixed[i])
            gradient[i].setZero();
    return value;
}

void StepObjective::accept(View<const Vec3> x)
{
    has_active_set_ = active_ && active_->activate(x);
    is_pcg_current_ = false;
}

Hessian* StepObjective::hessian()
{
    if (!hessian_)
        hessian_.emplace(system_.curvature(), inertia_, system_.fixed());
    hessian_->set_active(has_active_set_ ? active_ : nullptr);
    return &*hessian_;
}

bool StepObjective::is_minimiser(View<const Vec3> gradient, View<const Vec3> move, double tolerance) const
{
    const StepError error(system_.masses(), system_.fixed(), start_.x, start_.prediction, start_.dt);
    return error.is_within(tolerance, gradient, move, stop_);
}

/// Applies with active contact: minimisations then end at their iteration limit, and most of those iterations
/// change the error by nothing measurable (docs/journal/projective_dynamics.md).
double StepObjective::negligible_gain(double tolerance) const
{
    return has_active_set_ ? StepError::energy_of(tolerance, free_mass_, start_.dt) : 0.0;
}

void StepObjective::precondition(View<const Vec3> g, View<Vec3> z)
{
    if (has_active_set_)
        linear_iterations_ += pcg().solve(g, z).iterations;
    else
        system_.solver().solve(g, z);
}

/// Created when first needed, so never without active contact or with a method that has its own solver.
NestedPcg& StepObjective::pcg()
{
    if (!pcg_)
        pcg_.emplace(system_, start_.dt, contact_solve_);
    if (!is_pcg_current_)
        pcg_->update(*active_);
    is_pcg_current_ = true;
    return *pcg_;
}

} // namespace toile
