#include "core/pd/cuda/contact_descent.h"

#include "core/compute/cuda/record_sum.cuh"
#include "core/pd/cuda/body_kernels.h"
#include "core/pd/minimiser/recent_values.h"

namespace toile {

DeviceContactDescent::DeviceContactDescent(const CudaSpace& space, int vertex_count,
                                           const Pcg::Settings& contact_solve)
    : space_(space), pcg_(space, vertex_count, contact_solve), sums_(space), trial_(space, "descent/trial"),
      of_s_(space, "descent/of_s", kHistory)
{
}

void DeviceContactDescent::prepare(const System& system, DeviceSolver& solver)
{
    solver_ = &solver;
    pcg_.prepare(system, solver);
}

double DeviceContactDescent::evaluate(const DescentFields& fields, DeviceActiveSet& active)
{
    return measure(fields, active, 0.0).value;
}

/// Evaluates the trial point at `step` [-] along the direction. Waits.
ContactTrialSums DeviceContactDescent::measure(const DescentFields& fields, DeviceActiveSet& active,
                                               double step)
{
    const int n = fields.direction.size();
    add_gradient_({fields.trial.x, fields.trial.gradient, fields.energy.subview(0, n),
                   fields.energy.subview(n, fields.energy.size() - n)});
    active.evaluate(fields.trial.x, fields.trial.gradient, fields.energy.subview(0, n));
    parallel_sum_record_then<ContactTrialSums>(
        space_, "descent/measure", n, MeasureContactTrial{fields, active.frozen(), pairs_.pairs(), step},
        trial_.next(), sums_);
    const ContactTrialSums trial = trial_.await();
    has_active_contact_ = trial.active_count > 0.0;
    return trial;
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
        outcome.linear_iterations += find_direction(fields, active);
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
            restart(fields, active);
            continue;
        }
        outcome.value = trial.value;
        take(fields, outcome.converged ? nullptr : &trial.products);
        if (outcome.converged)
            break;
        ++outcome.iterations;
        outcome.displacement *= line.step;
        outcome.converged = recent.add_and_detect_stall(
            outcome.value,
            has_active_contact_ ? StepError::energy_of(task.settings.tolerance, task.mass, task.dt) : 0.0);
        if (outcome.converged)
            break;
    }
    return outcome;
}

/// Backtracks from a full step, which `trial` belongs to, until the value decreases sufficiently.
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

/// Drops the pairs, which leaves plain local/global.
void DeviceContactDescent::restart(const DescentFields& fields, DeviceActiveSet& active)
{
    pairs_.clear();
    parallel_for(space_, "descent/restart", fields.direction.size(), BeginAt{fields.here.x, fields});
    measure(fields, active, 0.0);
    take(fields, nullptr);
}

/// Makes the trial the current point. @param products  of its step; null: it gives no pair
void DeviceContactDescent::take(const DescentFields& fields, const StepProducts* products)
{
    const int slot = products != nullptr ? pairs_.add(*products) : -1;
    parallel_for(space_, "descent/take_point", fields.direction.size(),
                 TakePoint{{fields, pairs_.before()}, slot});
}

/// Computes the direction from the new point, and the trial at a full step. @return iterations of PCG
int DeviceContactDescent::find_direction(const DescentFields& fields, DeviceActiveSet& active)
{
    const int n = fields.direction.size();
    int iterations = 0;
    if (has_active_contact_) {
        iterations = pcg_.solve(active, fields.trial.z, fields.here.z).iterations;
    } else {
        solver_->solve_on_device(fields.trial.z, fields.here.z);
    }
    if (pairs_.count() > 0)
        parallel_sum_record_then<InverseProducts>(
            space_, "descent/measure_inverse", n, MeasureInverse{fields, pairs_.pairs()},
            FindCoefficients{pairs_, pairs_.before(), of_s_.view()}, sums_);
    parallel_for(space_, "descent/after_inverse", n,
                 AfterInverse{{fields, 1.0}, pairs_.pairs(), of_s_.view()});
    return iterations;
}

} // namespace toile
