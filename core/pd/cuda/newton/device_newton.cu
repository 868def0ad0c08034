#include <cmath>
#include <limits>
#include <utility>

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/cuda/record_sum.cuh"
#include "core/pd/cuda/newton/device_newton.h"
#include "core/pd/minimiser/line_search.h"

namespace toile {

DeviceNewton::DeviceNewton(const CudaSpace& space, View<const EmbeddedPoint> points,
                           const BlockMatrix& blocks, const SparseMatrix& isotropic, DeviceEnergies& energies,
                           DeviceSolver& global_solver)
    : space_(space), energies_(energies), global_solver_(global_solver),
      solver_(space, points, blocks, isotropic, energies), gradient_(space, "newton/gradient", points.size()),
      trial_x_(space, "newton/trial_x", points.size()),
      trial_gradient_(space, "newton/trial_gradient", points.size()),
      energy_(space, "newton/energy", points.size() + energies.partial_count()), sums_(space),
      trial_report_(space, "newton/trial"), start_report_(space, "newton/start"), moved_(space)
{
    gradient_.fill_zero();
}

void DeviceNewton::set_problem(const Problem& problem)
{
    problem_ = problem;
    parallel_sum_record_then<NewtonStartSums>(space_, "newton/start", problem.masses.size(),
                                              MeasureNewtonStart{problem.start, problem.v, problem.prediction,
                                                                 problem.masses, problem.inertia,
                                                                 problem.fixed, problem.dt},
                                              start_report_.next(), sums_);
    start_ = start_report_.await();
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
        MeasureNewtonTrial{energy_.view(), gradient_.view(), trial_gradient_.view(), solver_.direction(),
                           problem_.masses, problem_.inertia, problem_.fixed},
        trial_report_.next(), sums_);
    trial_ = trial_report_.await();
    return trial_;
}

double DeviceNewton::speed(double mass_square) const
{
    return start_.mass > 0.0 ? std::sqrt(mass_square / start_.mass) / problem_.dt : 0.0;
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

double DeviceNewton::max_speed() { return speed(bound_); }

NewtonSpace::Direction DeviceNewton::find_direction(bool is_first, double increment)
{
    freeze_here();
    solver_.update(problem_.x.device(), problem_.inertia, active(), is_first);
    return solver_.solve(gradient_.view(), increment);
}

NewtonSpace::Trial DeviceNewton::try_step(double length)
{
    parallel_for(space_, "newton/try_along", trial_x_.size(),
                 TryAlong{problem_.x.device(), solver_.direction(), length, trial_x_.view(), begin_trial()});
    const NewtonTrialSums sums = measure();
    return {sums.value, sums.slope, speed(sums.mass_square), std::sqrt(sums.largest_square)};
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
                 CopyPositions{trial_x_.view(), problem_.x.change_on_device()});
    std::swap(gradient_, trial_gradient_);
    bound_ = trial_.bound;
    is_frozen_here_ = true;
}

bool DeviceNewton::has_moved()
{
    return parallel_sum(space_, "newton/has_moved", trial_x_.size(), 0.0,
                        CountMoved{problem_.x.device(), trial_x_.view()}, moved_) > 0.0;
}

double DeviceNewton::driving_speed() { return speed(start_.driving); }

} // namespace toile
