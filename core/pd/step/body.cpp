#include "core/pd/step/body.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"
#include "core/pd/newton/embedded_points.h"
#include "core/pd/newton/rest_start.h"
#include "core/pd/step/step_tolerance.h"

namespace toile {

Body::Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings)
    : PointMassesOnHost(std::move(positions)), system_(std::move(system)), settings_(settings),
      prediction_(x_.size()), gradient_(x_.size()), x_previous_(x_), v_previous_(v_), restart_(x_.size(), 1),
      touched_(x_.size(), 0), touches_(x_.size(), 0), inertia_(x_.size())
{
    if (settings.outer == OuterMethod::Newton)
        newton_.emplace(embedded(x_), settings_.extent,
                        ComponentWeights(system_->masses(), system_->curvature().blocks(),
                                         system_->curvature().isotropic()));
    else
        outer_ = make_outer_loop(settings.outer, settings.history);
}

StepReport Body::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                      View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection)
{
    return take_step(*this, {dt, acceleration, fixed, targets, active, projection, max_error_},
                     {settings_.max_iterations, settings_.max_passes,
                      newton_ ? settings_.speed_tolerance : 0.0, settings_.begins_by_local_global},
                     patience_);
}

void Body::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    const double step = Bdf2::make(settings_.integrator, dt, previous_dt_).implicit_step();
    if (newton_ && !settings_.begins_by_local_global)
        system_->prepare_diagonal(step, fixed);
    else
        system_->prepare(step, fixed);
}

MotionView Body::motion()
{
    return {x_,           v_,       x_previous_,      v_previous_, restart_,
            touched_,     touches_, system_->fixed(), stiff_part_, part_touched_,
            part_touches_};
}

void Body::begin(const StepInput& input)
{
    dt_ = input.dt;
    if (std::isfinite(input.max_error))
        restart_before_ = restart_;
    if (previous_dt_ == 0.0 || dt_ > Bdf2::kMaxRatio * previous_dt_)
        std::fill(restart_.begin(), restart_.end(), 1);
    scheme_ = Bdf2::make(settings_.integrator, dt_, previous_dt_);
    prepare(dt_, input.fixed);
    predict(input);
    x_t1_ = prediction_;
    if (newton_)
        for (size_t i = 0; i < x_.size(); ++i)
            if (!input.fixed[i])
                x_t1_[i] = x_[i] + dt_ * v_[i];
    active_ = input.active;
    objective_.emplace(*system_, start(), input.active, settings_.contact_solve, settings_.stop);
}

void Body::predict(const StepInput& input)
{
    parallel_for(kCpu, "pd/predict", int(x_.size()),
                 PredictMotion{scheme_, motion(), input.acceleration, input.targets, system_->masses(),
                               prediction_, inertia_});
}

void Body::restart_touching(const StepInput& input)
{
    if (settings_.integrator == Integrator::ImplicitEuler)
        return;
    mark_touching(*input.active);
    parallel_for(kCpu, "pd/restart", int(x_.size()), RestartTouching{motion()});
    predict(input);
    forget_touching();
}

StepStart Body::start() const
{
    return {x_,  prediction_, system_->diagonal(), system_->fixed(), system_->masses(),
            dt_, inertia_,    newton_.has_value()};
}

/// Positions from outside begin a new motion.
void Body::set_positions(View<const Vec3> x)
{
    for (int i = 0; i < x.size(); ++i)
        if (x[i] != x_[i]) {
            restart_[i] = 1;
            x_previous_[i] = x[i]; // the former one may be unset
        }
    PointMassesOnHost::set_positions(x);
}

void Body::set_velocities(View<const Vec3> v)
{
    for (int i = 0; i < v.size(); ++i)
        if (v[i] != v_[i]) {
            restart_[i] = 1;
            v_previous_[i] = v[i];
        }
    PointMassesOnHost::set_velocities(v);
}

double Body::tolerance() const
{
    double max_move = 0.0;
    for (size_t i = 0; i < x_.size(); ++i)
        max_move = std::max(max_move, (prediction_[i] - x_[i]).norm());
    return StepTolerance{settings_.tolerance}.of_step(max_move);
}

OuterLoop::Outcome Body::minimise(ActiveSetEnergy*, int max_iterations, bool is_first)
{
    const OuterLoop::Settings settings{tolerance(), max_iterations};
    const int linear_iterations = objective_->linear_iterations();
    OuterLoop::Outcome outcome = outer_->minimise(*objective_, x_t1_, settings);
    if (is_first)
        outcome = no_worse_than_standing(settings, outcome);
    outcome.linear_iterations += objective_->linear_iterations() - linear_iterations;
    return outcome;
}

/// Restarts at the positions of t0 if that start has a lower value than the result from the prediction.
OuterLoop::Outcome Body::no_worse_than_standing(OuterLoop::Settings settings, const OuterLoop::Outcome& found)
{
    const RestStart rest{x_, prediction_, inertia_, system_->fixed()};
    standing_.resize(x_.size());
    if (found.value <= rest.value(*objective_, found.value, standing_, gradient_))
        return found;
    x_t1_ = standing_;
    settings.tolerance *= StepTolerance::kStanding;
    OuterLoop::Outcome outcome = outer_->minimise(*objective_, x_t1_, settings);
    outcome.iterations += found.iterations;
    outcome.linear_iterations += found.linear_iterations;
    return outcome;
}

OuterLoop::Outcome Body::minimise_by_newton(const Newton::Settings& settings, const Newton::Revise& revise,
                                            bool is_calm)
{
    newton_->set_problem(
        {&*objective_, x_t1_, x_, v_, prediction_, inertia_, system_->fixed(), dt_, active_});
    return Newton::minimise(*newton_, settings, revise, is_calm);
}

void Body::mark_touching(ActiveSetEnergy& active)
{
    if (settings_.integrator == Integrator::ImplicitEuler)
        return;
    active.mark_touching(x_t1_, touches_);
    mark_parts();
}

void Body::set_stiff_parts(const std::vector<int>& of_vertex)
{
    stiff_part_ = of_vertex;
    const int count = 1 + *std::max_element(of_vertex.begin(), of_vertex.end());
    part_touched_.assign(count, 0);
    part_touches_.assign(count, 0);
}

void Body::begin_anew()
{
    previous_dt_ = 0.0;
    std::fill(touched_.begin(), touched_.end(), 0);
}

void Body::mark_parts()
{
    const MarkPart mark{motion()};
    for (int i = 0; i < int(stiff_part_.size()); ++i)
        mark(i);
}

void Body::forget_touching()
{
    for (std::vector<unsigned char>* marks : {&touches_, &part_touched_, &part_touches_})
        std::fill(marks->begin(), marks->end(), 0);
}

double Body::local_error()
{
    return parallel_sum(kCpu, int(x_.size()), StepErrorSum{},
                        MotionError{scheme_, motion(), x_t1_, previous_dt_ == 0.0})
        .rms();
}

void Body::abandon()
{
    restart_ = restart_before_;
    forget_touching();
}

void Body::finish(StepProjection* projection)
{
    error_ = parallel_sum(kCpu, int(x_.size()), StepErrorSum{},
                          FinishMotion{scheme_, motion(), x_t1_, previous_dt_ == 0.0});
    minimiser_ = x_t1_;
    if (projection)
        projection->observe(x_t1_);
}

void Body::project(StepProjection& projection, const std::function<bool()>& clear_contacts)
{
    PointMassesOnHost::project(projection, dt_, system_->masses(), system_->fixed(), clear_contacts);
}

void Body::end(StepProjection*, StepReport& report)
{
    parallel_for(kCpu, "pd/end", int(x_.size()), EndMotion{motion(), minimiser_, x_t1_});
    forget_touching();
    previous_dt_ = dt_;
    report.step_error = error_.rms();
}

} // namespace toile
