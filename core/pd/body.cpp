#include "core/pd/body.h"

#include <cmath>
#include <utility>

#include "core/linear/field.h"

namespace toile {

Body::Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings)
    : x_(std::move(positions)), v_(x_.size(), Vec3::Zero()), system_(std::move(system)), settings_(settings),
      prediction_(x_.size()), x_t1_(x_.size()), inverse_masses_(x_.size())
{
}

StepReport Body::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                      View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection)
{
    StepReport report;
    report.steps = 1;
    system_->prepare(dt, fixed);
    predict(dt, acceleration, targets);

    x_t1_ = prediction_;
    if (active) {
        active->begin_step({x_, prediction_, system_->diagonal(), system_->fixed(), dt});
        active->make_feasible(x_t1_);
    }
    minimise(dt, active, report);
    if (report.status == StepReport::Status::NonFinite)
        return report;

    if (projection) {
        for (int i = 0; i < int(x_.size()); ++i)
            inverse_masses_[i] = fixed[i] ? 0.0 : 1.0 / system_->masses()[i];
        projection->project(x_t1_, inverse_masses_, active);
    }
    if (active)
        active->end_step(x_t1_);
    parallel_for(kCpu, "pd/finish", int(x_.size()), [&](int i) {
        v_[i] = (x_t1_[i] - x_[i]) / dt;
        x_[i] = x_t1_[i];
    });
    return report;
}

/// q* = x + dt v + dt^2 a; fixed vertices go to their targets.
void Body::predict(double dt, View<const Vec3> acceleration, View<const Vec3> targets)
{
    const View<const unsigned char> fixed = system_->fixed();
    parallel_for(kCpu, "pd/predict", int(x_.size()), [&](int i) {
        prediction_[i] = fixed[i] ? targets[i] : Vec3(x_[i] + dt * (v_[i] + dt * acceleration[i]));
    });
}

void Body::minimise(double dt, ActiveSetEnergy* active, StepReport& report)
{
    StepObjective objective(*system_, dt, prediction_, active, settings_.linear);
    const Lbfgs::Settings settings{settings_.tolerance, settings_.max_iterations, settings_.history};
    for (int round = 0; round < settings_.max_rounds; ++round) {
        const StageScope stage("pd/minimise");
        const Lbfgs::Outcome outcome = lbfgs_.minimise(objective, x_t1_, settings);
        report.iterations += outcome.iterations;
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
        if (!active || !active->revise(x_t1_))
            break;
    }
    report.linear_iterations = objective.linear_iterations();
}

} // namespace toile
