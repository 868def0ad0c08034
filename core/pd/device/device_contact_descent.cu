#include "core/pd/device/device_contact_descent.h"

#include "core/backend/cuda/record_sum.cuh"
#include "core/pd/recent_values.h"

namespace toile {

DeviceContactDescent::DeviceContactDescent(const CudaSpace& space, int vertex_count,
                                           const Pcg::Settings& contact_solve)
    : space_(space), pcg_(space, vertex_count, contact_solve), energies_(space, "descent/energies"),
      sums_(space), trial_(space, "descent/trial", 1), trial_on_host_(space, "descent/trial_on_host", 1),
      inverse_(space, "descent/inverse", 1), inverse_on_host_(space, "descent/inverse_on_host", 1)
{
}

void DeviceContactDescent::prepare(const System& system, DeviceSolver& solver)
{
    solver_ = &solver;
    pcg_.prepare(system, solver);
}

void DeviceContactDescent::record(const DeviceDescent::Problem& problem, const DescentFields& fields)
{
    const int n = fields.direction.size();
    energies_.record([&] {
        problem.add_gradient({fields.trial.x, fields.trial.gradient, fields.energy.subview(0, n),
                              fields.energy.subview(n, fields.energy.size() - n)});
    });
}

double DeviceContactDescent::evaluate(const DescentFields& fields, DeviceActiveSet& active)
{
    return measure(fields, active, 0.0).value;
}

/// Evaluates the trial point at `step` [-] of the direction, and freezes the terms that act there, since most
/// trials are taken. Waits.
ContactTrialSums DeviceContactDescent::measure(const DescentFields& fields, DeviceActiveSet& active,
                                               double step)
{
    const int n = fields.direction.size();
    energies_.launch();
    active.add_gradient(fields.trial.x, fields.trial.gradient, fields.energy.subview(0, n));
    active.activate(fields.trial.x);
    parallel_sum_record_then<ContactTrialSums>(space_, "descent/measure", n,
                                               MeasureContactTrial{fields, pairs_.pairs(), step},
                                               KeepTotal<ContactTrialSums>{trial_.view()}, sums_);
    trial_.download(trial_on_host_.view());
    space_.synchronise();
    return trial_on_host_[0];
}

OuterLoop::Outcome DeviceContactDescent::minimise(const DescentFields& fields, DeviceActiveSet& active,
                                                  const Task& task, double value)
{
    const StageScope stage("descent/contact");
    OuterLoop::Outcome outcome;
    outcome.value = value;
    RecentValues recent;
    recent.begin(value);
    pairs_.clear();
    take(fields, nullptr);
    while (is_finite(outcome.value) && outcome.iterations < task.settings.max_iterations) {
        find_direction(fields, active, outcome);
        parallel_for(space_, "descent/try", fields.direction.size(), TryStep{fields, 1.0});
        ContactTrialSums trial = measure(fields, active, 1.0);
        outcome.displacement = std::sqrt(trial.largest_square);
        trial.error.mass = task.mass;
        trial.error.driving = task.driving;
        outcome.converged = outcome.displacement <= task.settings.tolerance &&
                            trial.error.are_within(task.settings.tolerance, task.dt * task.dt, task.stop);
        if (outcome.converged && outcome.displacement <= kNegligibleMove * task.settings.tolerance)
            break;

        LineSearch line{outcome.value, trial.slope};
        if (!search(fields, active, trial, line)) {
            if (outcome.converged || pairs_.count() == 0)
                break;
            pairs_.clear();
            active.activate(fields.here.x);
            space_.synchronise();
            continue;
        }
        outcome.value = trial.value;
        take(fields, outcome.converged ? nullptr : &trial.products);
        if (outcome.converged)
            break;
        ++outcome.iterations;
        outcome.displacement *= line.step;
        outcome.converged = recent.add_and_tell_stall(
            outcome.value,
            active.acts() ? StepError::energy_of(task.settings.tolerance, task.mass, task.dt) : 0.0);
        if (outcome.converged)
            break;
    }
    return outcome;
}

/// Backtracks from a whole step, which `trial` is of, until the value decreases sufficiently.
bool DeviceContactDescent::search(const DescentFields& fields, DeviceActiveSet& active,
                                  ContactTrialSums& trial, LineSearch& line)
{
    if (!(line.slope < 0.0))
        return false;
    for (int attempt = 1; !line.accepts(trial.value); ++attempt) {
        if (attempt == LineSearch::kMaxTrials)
            return false;
        line.shorten(trial.value);
        parallel_for(space_, "descent/try", fields.direction.size(), TryStep{fields, line.step});
        trial = measure(fields, active, line.step);
    }
    return true;
}

/// The trial becomes the current point. @param products  of its step; null: it is no pair
void DeviceContactDescent::take(const DescentFields& fields, const StepProducts* products)
{
    const int slot = products != nullptr ? pairs_.add(*products) : -1;
    parallel_for(space_, "descent/take_point", fields.direction.size(), TakePoint{fields, slot});
}

void DeviceContactDescent::find_direction(const DescentFields& fields, DeviceActiveSet& active,
                                          OuterLoop::Outcome& outcome)
{
    const int n = fields.direction.size();
    const PairCoefficients alpha = pairs_.before();
    parallel_for(space_, "descent/before_inverse", n, BeforeInverse{fields, alpha});
    const auto measure_inverse = [&] {
        if (pairs_.count() == 0)
            return;
        parallel_sum_record_then<InverseProducts>(space_, "descent/measure_inverse", n,
                                                  MeasureInverse{fields, pairs_.pairs()},
                                                  KeepTotal<InverseProducts>{inverse_.view()}, sums_);
        inverse_.download(inverse_on_host_.view());
    };
    if (active.acts()) {
        pcg_.update(active);
        outcome.linear_iterations += pcg_.solve(fields.trial.z, fields.here.z, measure_inverse).iterations;
    } else {
        solver_->solve_there(fields.trial.z, fields.here.z);
        measure_inverse();
        space_.synchronise();
    }

    std::array<double, kHistory> y_z{};
    if (pairs_.count() > 0)
        std::copy(std::begin(inverse_on_host_[0].y_z), std::end(inverse_on_host_[0].y_z), y_z.begin());
    parallel_for(space_, "descent/after_inverse", n, AfterInverse{fields, pairs_.after(alpha, y_z)});
}

} // namespace toile
