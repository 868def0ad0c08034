#include "core/pd/step/body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/linear/field.h"
#include "core/pd/step/step_tolerance.h"

namespace toile {

namespace {

/// Tolerance of touching cloth [m/s] by the speed that external forces add in a step. In small steps that is
/// below any fixed tolerance: cloth that should begin to slide would stay where it is, step after step. The
/// error of its acceleration is at most about kOfDriving, and vanishes with the step below kDrivingOfStep,
/// gravity's speed in 1/120 s.
constexpr double kOfDriving = 0.15, kDrivingOfStep = 0.04;

/// Small Newton steps in succession after which touching cloth has converged. The first leaves contact forces
/// unbalanced by 14 % of the weight, which moves cloth by next to nothing, but friction by as much.
constexpr int kSmallSteps = 2;

double tolerance_by_driving(double driving)
{
    return kOfDriving * driving * std::min(1.0, driving / kDrivingOfStep);
}

std::vector<EmbeddedPoint> embedded(View<const Vec3> x)
{
    std::vector<EmbeddedPoint> points(x.size(), EmbeddedPoint::Zero());
    for (int i = 0; i < x.size(); ++i)
        points[i].head<3>() = x[i];
    return points;
}

} // namespace

Body::Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings)
    : PointMassesOnHost(std::move(positions)), system_(std::move(system)), settings_(settings),
      prediction_(x_.size()), gradient_(x_.size()), x_previous_(x_), v_previous_(v_), restart_(x_.size(), 1),
      touched_(x_.size(), 0), touches_(x_.size(), 0), inertia_(x_.size())
{
    if (settings.outer == OuterMethod::Newton)
        newton_.emplace(embedded(x_));
    else
        outer_ = make_outer_loop(settings.outer, settings.history);
}

StepReport Body::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                      View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection)
{
    return take_step(
        *this, {dt, acceleration, fixed, targets, active, projection},
        {settings_.max_iterations, settings_.max_passes, newton_ ? settings_.speed_tolerance : 0.0});
}

MotionView Body::motion()
{
    return {x_, v_, x_previous_, v_previous_, restart_, touched_, touches_, system_->fixed()};
}

void Body::begin(const StepInput& input)
{
    dt_ = input.dt;
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
    input.active->mark_touching(x_t1_, touches_);
    parallel_for(kCpu, "pd/restart", int(x_.size()), RestartTouching{motion()});
    predict(input);
    std::fill(touches_.begin(), touches_.end(), 0);
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

/// Value of the objective without motion [J], at standing_; infinite if its inertia alone exceeds `found`.
double Body::value_at_rest(double found)
{
    const View<const unsigned char> fixed = system_->fixed();
    standing_ = x_;
    for (size_t i = 0; i < x_.size(); ++i)
        if (fixed[int(i)])
            standing_[i] = prediction_[i];
    const double inertia = 0.5 * parallel_sum(kCpu, int(x_.size()), 0.0, [&](int i) {
                               return inertia_[i] * (standing_[i] - prediction_[i]).squaredNorm();
                           });
    if (found <= inertia)
        return std::numeric_limits<double>::infinity();
    const double value = objective_->evaluate(standing_, gradient_);
    return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
}

/// Restarts at the positions of t0 if that start has a lower value than the result from the prediction.
OuterLoop::Outcome Body::no_worse_than_standing(OuterLoop::Settings settings, const OuterLoop::Outcome& found)
{
    if (found.value <= value_at_rest(found.value))
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
    const double value = objective_->evaluate(x_t1_, gradient_);
    if (value_at_rest(value) < value)
        x_t1_ = standing_;
    else if (is_calm && !are_fixed_moving())
        step_local_global();
    Newton::Settings of_step = settings;
    if (!is_calm) {
        of_step.tolerance = std::min(settings.tolerance, tolerance_by_driving(driving_speed()));
        of_step.small_steps = kSmallSteps;
    }
    return newton_->minimise(*objective_, x_t1_, system_->masses(), of_step, revise);
}

/// RMS speed that external forces alone would add in the step [m/s].
double Body::driving_speed()
{
    parallel_for(kCpu, "pd/driving", int(x_.size()),
                 [&](int i) { standing_[i] = prediction_[i] - x_[i] - dt_ * v_[i]; });
    return objective_->speed_of(standing_);
}

/// True if a fixed vertex has another target than its position.
bool Body::are_fixed_moving() const
{
    const View<const unsigned char> fixed = system_->fixed();
    for (size_t i = 0; i < x_.size(); ++i)
        if (fixed[int(i)] && prediction_[i] != x_[i])
            return true;
    return false;
}

/// A local and a global step, x -= H^-1 g(x): the best first step while nothing touches.
void Body::step_local_global()
{
    const double before = objective_->evaluate(x_t1_, gradient_);
    standing_.resize(x_.size());
    objective_->precondition_linearly(gradient_, standing_);
    for (size_t i = 0; i < x_.size(); ++i)
        standing_[i] = x_t1_[i] - standing_[i];
    // H does not contain internal friction and may leave bending out.
    if (objective_->evaluate(standing_, gradient_) < before)
        x_t1_ = standing_;
}

void Body::finish(ActiveSetEnergy* active, StepProjection* projection)
{
    if (active && settings_.integrator != Integrator::ImplicitEuler)
        active->mark_touching(x_t1_, touches_);
    parallel_for(kCpu, "pd/finish", int(x_.size()), FinishMotion{scheme_, motion(), x_t1_});
    minimiser_ = x_t1_;
    if (projection)
        projection->observe(x_t1_);
}

void Body::project(StepProjection& projection, const std::function<bool()>& clear_contacts)
{
    PointMassesOnHost::project(projection, dt_, system_->masses(), system_->fixed(), clear_contacts);
}

void Body::end(StepProjection*, StepReport&)
{
    parallel_for(kCpu, "pd/end", int(x_.size()), EndMotion{motion(), minimiser_, x_t1_});
    previous_dt_ = dt_;
}

} // namespace toile
