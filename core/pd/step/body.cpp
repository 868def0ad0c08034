#include "core/pd/step/body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"
#include "core/pd/step/step_end.h"
#include "core/pd/step/step_passes.h"
#include "core/pd/step/step_tolerance.h"

namespace toile {

Body::Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings)
    : PointMassesOnHost(std::move(positions)), system_(std::move(system)), settings_(settings),
      outer_(make_outer_loop(settings.outer, settings.history)), prediction_(x_.size()), gradient_(x_.size())
{
}

StepReport Body::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                      View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection)
{
    StepReport report;
    report.steps = 1;
    system_->prepare(dt, fixed);
    predict(dt, acceleration, system_->fixed(), targets, prediction_);

    x_t1_ = prediction_;
    if (active) {
        active->begin_step(start_of(dt));
        active->make_feasible(x_t1_);
    }
    minimise(dt, active, report);
    if (report.status == StepReport::Status::NonFinite)
        return report;

    parallel_for(kCpu, "pd/finish", int(x_.size()), [&](int i) { v_[i] = (x_t1_[i] - x_[i]) / dt; });
    if (projection)
        projection->observe(x_t1_);
    StepEnd(x_t1_, v_, system_->masses(), system_->fixed(), dt).satisfy(active, projection);
    if (active)
        active->end_step(x_t1_);
    x_.swap(x_t1_);
    return report;
}

StepStart Body::start_of(double dt) const
{
    return {x_, prediction_, system_->diagonal(), system_->fixed(), system_->masses(), dt};
}

double Body::tolerance() const
{
    double max_move = 0.0;
    for (size_t i = 0; i < x_.size(); ++i)
        max_move = std::max(max_move, (prediction_[i] - x_[i]).norm());
    return StepTolerance{settings_.tolerance}.of_step(max_move);
}

/// Restarts at the positions of t0 if that start has a lower value than the result from the prediction. The
/// result is then no worse than no motion, W(x_t1) <= W(x_t0) + 1/2 |v + dt a|^2_M, however early the
/// minimisation stopped. Stiff cloth gains no energy from a bad start guess, and cloth at rest stays at rest.
OuterLoop::Outcome Body::no_worse_than_standing(double dt, StepObjective& objective,
                                                OuterLoop::Settings settings, const OuterLoop::Outcome& found)
{
    const View<const unsigned char> fixed = system_->fixed();
    standing_ = x_;
    for (size_t i = 0; i < x_.size(); ++i)
        if (fixed[int(i)])
            standing_[i] = prediction_[i];

    // The inertia without motion alone often exceeds the value found.
    const View<const double> masses = system_->masses();
    const double inertia = 0.5 / (dt * dt) * parallel_sum(kCpu, int(x_.size()), 0.0, [&](int i) {
                               return masses[i] * (standing_[i] - prediction_[i]).squaredNorm();
                           });
    if (found.value <= inertia)
        return found;
    const double value = objective.evaluate(standing_, gradient_);
    if (found.value <= value || !std::isfinite(value))
        return found;

    x_t1_ = standing_;
    settings.tolerance *= StepTolerance::kStanding;
    OuterLoop::Outcome outcome = outer_->minimise(objective, x_t1_, settings);
    outcome.iterations += found.iterations;
    outcome.linear_iterations += found.linear_iterations;
    return outcome;
}

void Body::minimise(double dt, ActiveSetEnergy* active, StepReport& report)
{
    StepObjective objective(*system_, start_of(dt), active, settings_.contact_solve, settings_.stop);
    OuterLoop::Settings settings{tolerance(), settings_.max_iterations};
    StepPasses passes(settings_.max_iterations, settings_.max_passes);
    for (bool goes_on = true; goes_on;) {
        const StageScope stage("pd/minimise");
        settings.max_iterations = passes.next(active && active->may_be_active());
        OuterLoop::Outcome outcome = outer_->minimise(objective, x_t1_, settings);
        if (passes.is_first())
            outcome = no_worse_than_standing(dt, objective, settings, outcome);
        report.iterations += outcome.iterations;
        report.linear_iterations += outcome.linear_iterations;
        report.displacement = outcome.displacement;
        report.gradient_norm = outcome.gradient_norm;
        report.energy = outcome.value;
        report.status =
            outcome.converged ? StepReport::Status::Converged : StepReport::Status::IterationLimit;
        if (!std::isfinite(outcome.value)) {
            report.status = StepReport::Status::NonFinite;
            report.message = "the energy at the start of the step is not finite";
            break;
        }
        const bool has_changed = active && active->revise(x_t1_, passes.is_converged(outcome));
        goes_on = passes.goes_on(outcome, has_changed);
    }
    report.linear_iterations += objective.linear_iterations();
}

} // namespace toile
