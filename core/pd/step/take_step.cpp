#include "core/pd/step/take_step.h"

#include <cmath>

#include "core/base/stages.h"
#include "core/pd/step/step_passes.h"

namespace toile {

namespace {

void add(StepReport& report, const OuterLoop::Outcome& outcome)
{
    report.iterations += outcome.iterations;
    report.linear_iterations += outcome.linear_iterations;
    report.displacement = outcome.displacement;
    report.speed = outcome.speed;
    report.gradient_norm = outcome.gradient_norm;
    report.energy = outcome.value;
    report.status = outcome.converged ? StepReport::Status::Converged : StepReport::Status::IterationLimit;
    if (!std::isfinite(outcome.value)) {
        report.status = StepReport::Status::NonFinite;
        report.message = "the energy at the start of the step is not finite";
    }
}

/// Report on a step that is not taken.
StepReport refused(const StepReport& tried, double error)
{
    StepReport report;
    report.refused = 1;
    report.iterations = tried.iterations;
    report.linear_iterations = tried.linear_iterations;
    report.step_error = error;
    return report;
}

void minimise(StepSpace& space, ActiveSetEnergy* active, const StepLimits& limits, StepReport& report)
{
    StepPasses passes(limits.max_iterations, limits.max_passes);
    for (bool goes_on = true; goes_on;) {
        const StageScope stage("pd/minimise");
        const int max_iterations = passes.next(active && active->may_be_active());
        const OuterLoop::Outcome outcome = space.minimise(active, max_iterations, passes.is_first());
        add(report, outcome);
        if (report.status == StepReport::Status::NonFinite)
            return;
        const bool has_changed =
            active &&
            active->revise(space.end_positions(), passes.is_converged(outcome) ? MinimiserProgress::kConverged
                                                                               : MinimiserProgress::kFar);
        goes_on = passes.goes_on(outcome, has_changed);
    }
}

void minimise_by_newton(StepSpace& space, const StepInput& input, const StepLimits& limits,
                        Newton::Patience& patience, StepReport& report)
{
    const StageScope stage("pd/minimise");
    ActiveSetEnergy* const active = input.active;
    const bool is_calm = !active || !active->may_be_active();
    Newton::Revise revise;
    if (active)
        revise = [&](MinimiserProgress at) { return active->revise(space.end_positions(), at); };
    const double tolerance = (is_calm ? StepLimits::kCalm : 1.0) * limits.speed_tolerance;
    const Newton::Settings settings{tolerance, limits.max_iterations, input.dt, limits.begins_by_local_global,
                                    patience.setbacks()};
    add(report, space.minimise_by_newton(settings, revise, is_calm));
    patience.observe(report.status == StepReport::Status::Converged);
}

/// Keeps apart what must not cross. Where the minimiser's result does not stand, satisfies contact and limits
/// before. Cloth that contact moves back stretches against cloth that it does not move, so the limits are
/// then applied again.
void correct(StepSpace& space, const StepInput& input, bool stands)
{
    ActiveSetEnergy* const active = input.active;
    if (stands) {
        if (active)
            active->keep_apart(space.end_positions(), space.end_velocities());
        return;
    }
    std::function<bool()> clear_contacts;
    if (active)
        clear_contacts = [&] { return active->sweep_once(space.end_positions()); };
    bool goes_on = true;
    for (int correction = 0; goes_on && correction < kMaxCorrections; ++correction) {
        if (active)
            active->clear(space.end_positions(), space.end_velocities());
        if (input.projection) {
            const StageScope stage("pd/limits");
            space.project(*input.projection, clear_contacts);
        }
        goes_on = active && active->keep_apart(space.end_positions(), space.end_velocities());
    }
}

} // namespace

StepReport take_step(StepSpace& space, const StepInput& input, const StepLimits& limits,
                     Newton::Patience& patience)
{
    StepReport report;
    report.steps = 1;
    space.begin(input);
    if (input.active) {
        input.active->begin_step(space.start());
        space.restart_touching(input);
        input.active->make_feasible(space.end_positions());
    }
    Newton::Patience after = patience;
    if (limits.speed_tolerance > 0.0)
        minimise_by_newton(space, input, limits, after, report);
    else
        minimise(space, input.active, limits, report);
    if (report.status == StepReport::Status::NonFinite)
        return report;

    if (input.active)
        space.mark_touching(*input.active);
    if (std::isfinite(input.max_error))
        if (const double error = space.local_error(); error > input.max_error) {
            space.abandon();
            if (input.active)
                input.active->abandon_step();
            return refused(report, error);
        }
    patience = after;
    space.finish(input.projection);
    const bool stands = limits.speed_tolerance > 0.0 && (!input.active || input.active->is_complete());
    correct(space, input, stands);
    if (input.active)
        input.active->end_step(space.end_positions());
    space.end(input.projection, report);
    return report;
}

} // namespace toile
