#include "core/pd/newton/host_newton.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/linear/field.h"
#include "core/pd/newton/rest_start.h"

namespace toile {

void HostNewton::set_problem(const Problem& problem)
{
    problem_ = problem;
    for (std::vector<Vec3>* field : {&gradient_, &direction_, &trial_, &trial_gradient_})
        field->resize(problem.x.size());
    double stiffness = 0.0;
    for (int i = 0; i < problem.x.size(); ++i)
        stiffness += problem.fixed[i] ? 0.0 : problem.inertia[i];
    weights_.set_fixed(problem.fixed);
    stop_.begin_step(stiffness * weights_.lightest(), problem.dt);
}

double HostNewton::evaluate() { return problem_.objective->evaluate(problem_.x, gradient_); }

/// RMS speed [m/s] of a field whose squares add up to this, by weight [kg m^2].
double HostNewton::speed(double weighted_square) const
{
    return weights_.mass() > 0.0 ? std::sqrt(weighted_square / weights_.mass()) / problem_.dt : 0.0;
}

double HostNewton::max_speed()
{
    return stop_.speed(parallel_sum(kCpu, int(gradient_.size()), 0.0, [&](int i) {
        return problem_.fixed[i] ? 0.0 : gradient_[i].squaredNorm() / problem_.inertia[i];
    }));
}

NewtonSpace::Solution HostNewton::find_direction(bool is_first, double error)
{
    Objective& objective = *problem_.objective;
    objective.accept(problem_.x);
    Hessian* const K = objective.hessian();
    if (K == nullptr)
        throw InvalidInput("newton: the objective has no second derivatives; choose another method");
    K->linearise(problem_.x, Definiteness::Projected);
    solver_.update(K->parts(), coarse_age_.is_over(is_first));
    correction_.resize(problem_.x.size());
    stop_.begin_direction(is_first);
    const Solution solution = solve(gradient_, error);
    direction_ = correction_;
    return solution;
}

NewtonSpace::Solution HostNewton::solve(View<const Vec3> gradient, double error)
{
    const HessianSolver::Outcome outcome = solver_.solve(gradient, stop_.at(error), correction_);
    stop_.take(outcome);
    coarse_age_.take(outcome.iterations);
    return {outcome.iterations, outcome.is_solved, stop_.speed(outcome.error), stop_.speed(outcome.size),
            -0.5 * dot(gradient, correction_)};
}

bool HostNewton::has_contact()
{
    if (problem_.active == nullptr || !problem_.active->may_be_active())
        return false;
    const int n = problem_.x.size();
    for (std::vector<Vec3>* field : {&base_, &contact_gradient_})
        field->assign(n, Vec3::Zero());
    product_.resize(n);
    model_gradient_.resize(n);
    contact_here_ = problem_.active->add_gradient(problem_.x, contact_gradient_);
    gradient_without_contact_.resize(n);
    for (int i = 0; i < n; ++i)
        gradient_without_contact_[i] =
            problem_.fixed[i] ? Vec3(Vec3::Zero()) : Vec3(gradient_[i] - contact_gradient_[i]);
    return true;
}

double HostNewton::model(double length)
{
    parallel_for(
        kCpu, "newton/model", problem_.x.size(),
        [&](int i) {
            direction_[i] = base_[i] + length * correction_[i];
            trial_[i] = problem_.x[i] + direction_[i];
            contact_gradient_[i].setZero();
        },
        kFieldGrain);
    const double contact = problem_.active->add_gradient(trial_, contact_gradient_);
    problem_.objective->hessian()->multiply_without_active_set(direction_, product_);
    return dot(gradient_without_contact_, direction_) + 0.5 * dot(direction_, product_) + contact -
           contact_here_;
}

NewtonSpace::Solution HostNewton::correct(double error)
{
    base_ = direction_;
    for (int i = 0; i < problem_.x.size(); ++i)
        model_gradient_[i] = problem_.fixed[i]
                                 ? Vec3(Vec3::Zero())
                                 : Vec3(gradient_without_contact_[i] + product_[i] + contact_gradient_[i]);
    problem_.objective->accept(trial_);
    Hessian* const K = problem_.objective->hessian();
    K->update_active_set();
    solver_.update(K->parts(), false);
    return solve(model_gradient_, error);
}

NewtonSpace::Trial HostNewton::try_step(double length)
{
    parallel_for(
        kCpu, "newton/trial", problem_.x.size(),
        [&](int i) { trial_[i] = problem_.x[i] + length * direction_[i]; }, kFieldGrain);
    Trial trial;
    trial.value = problem_.objective->evaluate(trial_, trial_gradient_);
    trial.slope = dot(gradient_, direction_);
    trial.end_slope = dot(trial_gradient_, direction_);
    const View<const double> weights = weights_.all();
    trial.speed = speed(parallel_sum(kCpu, weights.size(), 0.0,
                                     [&](int i) { return weights[i] * direction_[i].squaredNorm(); }));
    trial.displacement = max_norm(direction_);
    return trial;
}

double HostNewton::try_rest(double limit)
{
    const RestStart rest{problem_.start, problem_.prediction, problem_.inertia, problem_.fixed};
    return rest.value(*problem_.objective, limit, trial_, trial_gradient_);
}

double HostNewton::try_local_global()
{
    problem_.objective->precondition_linearly(gradient_, trial_);
    for (int i = 0; i < problem_.x.size(); ++i)
        trial_[i] = problem_.x[i] - trial_[i];
    return problem_.objective->evaluate(trial_, trial_gradient_);
}

void HostNewton::take()
{
    before_.assign(problem_.x.begin(), problem_.x.end());
    std::copy(trial_.begin(), trial_.end(), problem_.x.begin());
    gradient_.swap(trial_gradient_);
}

void HostNewton::retake(double length)
{
    parallel_for(
        kCpu, "newton/retake", problem_.x.size(),
        [&](int i) { problem_.x[i] = trial_[i] = before_[i] + length * direction_[i]; }, kFieldGrain);
}

void HostNewton::keep() { kept_.assign(problem_.x.begin(), problem_.x.end()); }

void HostNewton::restore() { std::copy(kept_.begin(), kept_.end(), problem_.x.begin()); }

bool HostNewton::has_moved() { return !std::equal(problem_.x.begin(), problem_.x.end(), trial_.begin()); }

double HostNewton::driving_speed()
{
    const Problem& p = problem_;
    const View<const double> weights = weights_.all();
    return speed(parallel_sum(kCpu, weights.size(), 0.0, [&](int i) {
        return weights[i] * (p.prediction[i] - p.start[i] - p.dt * p.v[i]).squaredNorm();
    }));
}

bool HostNewton::are_fixed_moving()
{
    for (int i = 0; i < problem_.x.size(); ++i)
        if (problem_.fixed[i] && problem_.prediction[i] != problem_.start[i])
            return true;
    return false;
}

double HostNewton::gradient_norm() { return max_norm(gradient_); }

} // namespace toile
