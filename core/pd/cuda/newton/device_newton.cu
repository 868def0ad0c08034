#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/compute/copy_items.h"
#include "core/compute/cuda/parallel.cuh"
#include "core/compute/cuda/record_sum.cuh"
#include "core/pd/cuda/newton/device_newton.h"
#include "core/pd/minimiser/line_search.h"

namespace toile {

DeviceNewton::DeviceNewton(const CudaSpace& space, View<const EmbeddedPoint> points,
                           View<const double> masses, const BlockMatrix& blocks,
                           const SparseMatrix& isotropic, Extent extent, DeviceEnergies& energies,
                           DeviceSolver& global_solver)
    : space_(space), energies_(energies), global_solver_(global_solver),
      solver_(space, points, blocks, isotropic, extent, energies), weights_(masses, blocks, isotropic),
      device_weights_(space, "newton/weights"), gradient_(space, "newton/gradient", points.size()),
      trial_x_(space, "newton/trial_x", points.size()),
      trial_gradient_(space, "newton/trial_gradient", points.size()),
      before_(space, "newton/before", points.size()), kept_(space, "newton/kept", points.size()),
      energy_(space, "newton/energy", points.size() + energies.partial_count()),
      direction_(space, "newton/direction", points.size()), base_(space, "newton/base"),
      gradient_without_contact_(space, "newton/gradient_without_contact"),
      contact_gradient_(space, "newton/contact_gradient"), model_gradient_(space, "newton/model_gradient"),
      contact_energy_(space, "newton/contact_energy"), sums_(space), model_report_(space, "newton/model"),
      trial_report_(space, "newton/trial"), start_report_(space, "newton/start"), moved_(space),
      decrease_(space)
{
    gradient_.fill_zero();
    direction_.fill_zero();
    device_weights_.upload(weights_.all());
}

void DeviceNewton::set_fixed(const std::vector<unsigned char>& fixed)
{
    solver_.set_fixed(fixed);
    weights_.set_fixed(fixed);
    device_weights_.upload(weights_.all());
}

void DeviceNewton::set_problem(const Problem& problem)
{
    problem_ = problem;
    parallel_sum_record_then<NewtonStartSums>(space_, "newton/start", trial_x_.size(),
                                              MeasureNewtonStart{problem.start, problem.v, problem.prediction,
                                                                 device_weights_.view(), problem.inertia,
                                                                 problem.fixed, problem.dt},
                                              start_report_.next(), sums_);
    start_ = start_report_.await();
    stop_.begin_step(start_.stiffness * weights_.lightest(), problem.dt);
}

BeginNewtonTrial DeviceNewton::begin_trial()
{
    return {{problem_.inertia, problem_.prediction, trial_x_.view(), trial_gradient_.view()}, energy_.view()};
}

/// The active set, if it has terms.
DeviceActiveSet* DeviceNewton::active()
{
    if (problem_.active == nullptr || !problem_.active->may_be_active())
        return nullptr;
    DeviceActiveSet* const active = problem_.active->on_device(space_);
    return active->has_terms() && active->frozen().vertices.size() > 0 ? active : nullptr;
}

/// Freezes the active set's terms at the current point.
void DeviceNewton::freeze_here()
{
    DeviceActiveSet* const active = this->active();
    if (is_frozen_here_ || active == nullptr)
        return;
    // Only the terms are wanted: the next trial overwrites the rest.
    active->evaluate(problem_.x.device(), trial_gradient_.view(), energy_.view().subview(0, trial_x_.size()));
    is_frozen_here_ = true;
}

/// Evaluates the trial point, whose inertia is there. Waits.
NewtonTrialSums DeviceNewton::measure()
{
    const int n = trial_x_.size();
    is_frozen_here_ = false;
    const View<double> of_vertices = energy_.view().subview(0, n);
    energies_.add_gradient({trial_x_.view(), trial_gradient_.view(), of_vertices,
                            energy_.view().subview(n, energy_.size() - n)});
    if (DeviceActiveSet* const active = this->active())
        active->evaluate(trial_x_.view(), trial_gradient_.view(), of_vertices);
    parallel_sum_record_then<NewtonTrialSums>(
        space_, "newton/measure", n,
        MeasureNewtonTrial{energy_.view(), gradient_.view(), trial_gradient_.view(), direction_.view(),
                           device_weights_.view(), problem_.inertia, problem_.fixed},
        trial_report_.next(), sums_);
    trial_ = trial_report_.await();
    return trial_;
}

/// RMS speed [m/s] of a field whose squares add up to this, by weight [kg m^2].
double DeviceNewton::speed(double weighted_square) const
{
    return weights_.mass() > 0.0 ? std::sqrt(weighted_square / weights_.mass()) / problem_.dt : 0.0;
}

double DeviceNewton::evaluate()
{
    parallel_for(space_, "newton/try_here", trial_x_.size(),
                 TryHere{problem_.x.device(), trial_x_.view(), begin_trial()});
    const double value = measure().value;
    std::swap(gradient_, trial_gradient_);
    bound_ = trial_.bound;
    is_frozen_here_ = true;
    return value;
}

double DeviceNewton::max_speed() { return stop_.speed(bound_); }

NewtonSpace::Solution DeviceNewton::find_direction(bool is_first, double error)
{
    freeze_here();
    solver_.update(problem_.x.device(), problem_.inertia, active(), coarse_age_.is_over(is_first));
    stop_.begin_direction(is_first);
    const Solution solution = solve(gradient_.view(), error);
    parallel_for(space_, "newton/copy_direction", direction_.size(),
                 CopyDirection{solver_.direction(), direction_.view()});
    return solution;
}

NewtonSpace::Solution DeviceNewton::solve(View<const Vec3> gradient, double error)
{
    const HessianSolver::Outcome outcome = solver_.solve(gradient, stop_.at(error));
    stop_.take(outcome);
    coarse_age_.take(outcome.iterations);
    const double promised = active()
                                ? parallel_sum(space_, "newton/decrease", gradient.size(), 0.0,
                                               PromisedDecrease{gradient, solver_.direction()}, decrease_)
                                : 0.0;
    return {outcome.iterations, outcome.is_solved, stop_.speed(outcome.error), stop_.speed(outcome.size),
            0.5 * promised};
}

/// Evaluates contact alone, and freezes its terms.
void DeviceNewton::evaluate_contact(View<const Vec3> x)
{
    is_frozen_here_ = false;
    active()->evaluate(x, contact_gradient_.view(), contact_energy_.view());
}

bool DeviceNewton::has_contact()
{
    if (active() == nullptr)
        return false;
    const int n = trial_x_.size();
    base_.resize(n);
    base_.fill_zero();
    for (DeviceArray<Vec3>* field : {&gradient_without_contact_, &contact_gradient_, &model_gradient_})
        field->resize(n);
    contact_energy_.resize(n);
    contact_gradient_.fill_zero();
    contact_energy_.fill_zero();
    evaluate_contact(problem_.x.device());
    contact_here_ = parallel_sum(space_, "newton/remove_contact", n, 0.0,
                                 RemoveContact{gradient_.view(), contact_gradient_.view(),
                                               contact_energy_.view(), gradient_without_contact_.view()},
                                 decrease_);
    return true;
}

double DeviceNewton::model(double length)
{
    const int n = trial_x_.size();
    parallel_for(space_, "newton/begin_model", n,
                 BeginModel{problem_.x.device(), base_.view(), solver_.direction(), length, direction_.view(),
                            trial_x_.view(), contact_gradient_.view(), contact_energy_.view()});
    evaluate_contact(trial_x_.view());
    parallel_sum_record_then<ModelSums>(space_, "newton/model", n,
                                        MeasureModel{solver_.hessian(), direction_.view(),
                                                     gradient_without_contact_.view(),
                                                     contact_gradient_.view(), contact_energy_.view(),
                                                     problem_.fixed, model_gradient_.view()},
                                        model_report_.next(), sums_);
    const ModelSums sums = model_report_.await();
    return sums.elastic + sums.contact - contact_here_;
}

NewtonSpace::Solution DeviceNewton::correct(double error)
{
    parallel_for(space_, "newton/copy_direction", direction_.size(),
                 CopyDirection{direction_.view(), base_.view()});
    solver_.update_active_set(active());
    return solve(model_gradient_.view(), error);
}

NewtonSpace::Trial DeviceNewton::try_step(double length)
{
    parallel_for(space_, "newton/try_along", trial_x_.size(),
                 TryAlong{problem_.x.device(), direction_.view(), length, trial_x_.view(), begin_trial()});
    const NewtonTrialSums sums = measure();
    return {sums.value, sums.slope, sums.end_slope, speed(sums.weighted_square),
            std::sqrt(sums.largest_square)};
}

double DeviceNewton::try_rest(double limit)
{
    if (limit <= start_.inertia)
        return std::numeric_limits<double>::infinity();
    parallel_for(
        space_, "newton/try_rest", trial_x_.size(),
        TryRest{problem_.start, problem_.prediction, problem_.fixed, trial_x_.view(), begin_trial()});
    const double value = measure().value;
    return is_finite(value) ? value : std::numeric_limits<double>::infinity();
}

double DeviceNewton::try_local_global()
{
    parallel_for(space_, "newton/free_gradient", trial_x_.size(),
                 CopyFreeGradient{gradient_.view(), problem_.fixed, trial_gradient_.view()});
    global_solver_.solve_on_device(trial_gradient_.view(), trial_x_.view());
    parallel_for(
        space_, "newton/try_local_global", trial_x_.size(),
        TryLocalGlobal{problem_.x.device(), trial_x_.view(), problem_.fixed, trial_x_.view(), begin_trial()});
    return measure().value;
}

void DeviceNewton::take()
{
    parallel_for(space_, "newton/take", trial_x_.size(),
                 MakeCurrent{trial_x_.view(), problem_.x.change_on_device(), before_.view()});
    std::swap(gradient_, trial_gradient_);
    bound_ = trial_.bound;
    is_frozen_here_ = true;
}

void DeviceNewton::retake(double length)
{
    parallel_for(
        space_, "newton/retake", trial_x_.size(),
        Retake{before_.view(), direction_.view(), length, trial_x_.view(), problem_.x.change_on_device()});
}

void DeviceNewton::keep()
{
    parallel_for(space_, "newton/keep", trial_x_.size(), CopyItems<Vec3>{problem_.x.device(), kept_.view()});
}

void DeviceNewton::restore()
{
    parallel_for(space_, "newton/restore", trial_x_.size(),
                 CopyItems<Vec3>{kept_.view(), problem_.x.change_on_device()});
}

bool DeviceNewton::has_moved()
{
    return parallel_sum(space_, "newton/has_moved", trial_x_.size(), 0.0,
                        CountMoved{problem_.x.device(), trial_x_.view()}, moved_) > 0.0;
}

double DeviceNewton::driving_speed() { return speed(start_.driving); }

} // namespace toile
