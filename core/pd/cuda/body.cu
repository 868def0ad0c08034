#include "core/pd/cuda/body.h"

#include <cmath>

#include "core/base/error.h"
#include "core/compute/copy_items.h"
#include "core/compute/cuda/parallel.cuh"
#include "core/pd/newton/embedded_points.h"

namespace toile {

namespace {

DeviceSolver* device_solver_of(System& system, const CudaSpace& space)
{
    DeviceSolver* solver = system.solver().on_device();
    if (solver == nullptr)
        throw InvalidInput("this global solver does not run on a GPU; quadrature does");
    if (&solver->space() != &space)
        throw InvalidInput("the global solver was made for another stream or device than the body");
    return solver;
}

DeviceEnergies energies_of(const CudaSpace& space, const System& system)
{
    DeviceEnergies energies(space);
    for (const auto& energy : system.energies())
        if (!energy->add_to(energies, 0))
            throw InvalidInput(std::string(energy->name()) + " does not run on a GPU");
    return energies;
}

} // namespace

DeviceBody::DeviceBody(const CudaSpace& space, const std::vector<Vec3>& positions,
                       std::unique_ptr<System> system, Settings settings)
    : space_(space), system_(std::move(system)), solver_(device_solver_of(*system_, space)),
      settings_(settings), energies_(energies_of(space, *system_)),
      x_(space, "body/x", int(positions.size())), v_(space, "body/v", x_.size()),
      x_t1_(space, "body/x_t1", x_.size()), acceleration_(space, "body/acceleration", x_.size()),
      prediction_(space, "body/prediction", x_.size()), readbacks_(space, "body/readback"),
      targets_(space, "body/targets", x_.size()), fixed_vertices_(space, "body/fixed_vertices"),
      fixed_targets_(space, "body/fixed_targets"),
      fixed_targets_on_host_(space, "body/fixed_targets_on_host"),
      x_previous_(space, "body/x_previous", x_.size()), v_previous_(space, "body/v_previous", x_.size()),
      restart_(space, "body/restart", x_.size()), touched_(space, "body/touched", x_.size()),
      touches_(space, "body/touches", x_.size()), stiff_part_(space, "body/stiff_part"),
      part_touched_(space, "body/part_touched"), part_touches_(space, "body/part_touches"),
      restart_before_(space, "body/restart_before", x_.size()), error_sums_(space),
      minimiser_(space, "body/minimiser", x_.size()), inertia_(space, "body/inertia", x_.size()),
      found_(space, "body/found", x_.size()), masses_(space, "body/masses"),
      diagonal_(space, "body/diagonal"), inverse_masses_(space, "body/inverse_masses"),
      fixed_(space, "body/fixed"), begin_sums_(space, "body/begin_sums", block_count(x_.size(), kSumItems)),
      finish_sums_(space, "body/finish_sums", block_count(x_.size(), kSumItems)),
      end_sums_(space, "body/end_sums", block_count(x_.size(), kSumItems)),
      finished_(space, "body/finished", 1), speed_(space, "body/largest_speed", 1),
      drive_(space, "body/drive"), found_gradient_(space, "body/found_gradient")
{
    TOILE_ASSERT(x_.size() == system_->vertex_count());
    masses_.upload(system_->masses());
    if (settings_.outer == OuterMethod::Newton) {
        const Curvature curvature(x_.size(), system_->energies());
        newton_.emplace(space_, embedded(positions), system_->masses(), curvature.blocks(),
                        curvature.isotropic(), settings_.extent, energies_, *solver_);
    } else {
        descent_.emplace(space_, x_.size(), energies_.partial_count());
        drive_.resize(x_.size());
        found_gradient_.resize(x_.size());
    }
    for (DeviceArray<unsigned char>* flags : {&touched_, &touches_})
        flags->fill_zero();
    for (DeviceArray<Vec3>* field : {&x_previous_, &v_previous_})
        field->fill_zero();
    set_positions(positions);
    set_velocities(std::vector<Vec3>(positions.size(), Vec3::Zero()));
}

void DeviceBody::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    TOILE_ASSERT(int(fixed.size()) == x_.size());
    const double step = Bdf2::make(settings_.integrator, dt, previous_dt_).implicit_step();
    const bool is_new_step = step != prepared_step_, is_new_set = fixed != host_fixed_;
    prepared_step_ = 0.0; // not prepared, should the solver refuse H
    if (newton_ && !settings_.begins_by_local_global)
        system_->prepare_diagonal(step, fixed);
    else
        system_->prepare(step, fixed);
    if (is_new_set)
        set_fixed(fixed);
    if (is_new_set || is_new_step) {
        diagonal_.upload(system_->diagonal());
        if (!newton_)
            descent_->record(problem());
        is_contact_prepared_ = false;
    }
    prepared_step_ = step;
    dt_ = dt;
}

DeviceDescent::Problem DeviceBody::problem()
{
    return {[this](const DeviceEvaluation& at) { energies_.add_gradient(at); },
            [this](View<const Vec3> g, View<Vec3> z) { solver_->solve_on_device(g, z); },
            masses_.view(),
            fixed_.view(),
            prediction_.device(),
            drive_.view(),
            inertia_.view()};
}

StepReport DeviceBody::step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                            View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection)
{
    const StageScope stage("pd/device_step");
    return take_step(*this, {dt, acceleration, fixed, targets, active, projection, max_error_},
                     {settings_.max_iterations, settings_.max_passes,
                      newton_ ? settings_.speed_tolerance : 0.0, settings_.begins_by_local_global},
                     patience_);
}

void DeviceBody::begin(const StepInput& input)
{
    if (input.projection && input.projection->on_device(space_) == nullptr)
        throw InvalidInput("this constraint does not run on a GPU");
    if (input.active && input.active->on_device(space_) == nullptr)
        throw InvalidInput("this contact does not run on a GPU");
    scheme_ = Bdf2::make(settings_.integrator, input.dt, previous_dt_);
    if (std::isfinite(input.max_error))
        parallel_for(space_, "pd/keep_restart", restart_.size(),
                     CopyItems<unsigned char>{restart_.view(), restart_before_.view()});
    if (previous_dt_ == 0.0 || input.dt > Bdf2::kMaxRatio * previous_dt_)
        restart_all();
    prepare(input.dt, input.fixed);
    begin_forces(input.acceleration);
    begin_targets(input.targets);
    for (const auto& energy : energies_.all())
        energy->begin_step(x_.device(), input.dt);
    active_ = input.active;
    predict();
}

StepStart DeviceBody::start() const
{
    return {{},
            {},
            system_->diagonal(),
            system_->fixed(),
            system_->masses(),
            dt_,
            {},
            newton_.has_value(),
            {x_.device(), prediction_.device(), diagonal_.view(), fixed_.view(), masses_.view()}};
}

void DeviceBody::project(StepProjection& projection, const std::function<bool()>& clear_contacts)
{
    DeviceStepProjection& limits = *projection.on_device(space_);
    if (limits.is_satisfied(x_t1_.device()))
        return;
    parallel_for(space_, "pd/keep_unprojected", x_.size(), CopyItems<Vec3>{x_t1_.device(), found_.view()});
    limits.project(x_t1_.change_on_device(), inverse_masses_.view(), clear_contacts);
    parallel_for(space_, "pd/projected", x_.size(),
                 AddProjected{found_.view(), x_t1_.device(), dt_, v_.change_on_device()});
}

void DeviceBody::restart_touching(const StepInput& input)
{
    if (settings_.integrator == Integrator::ImplicitEuler)
        return;
    mark_touching(*input.active);
    parallel_for(space_, "pd/restart", x_.size(), RestartTouching{motion()});
    predict_motion();
    forget_touching();
}

OuterLoop::Outcome DeviceBody::minimise_by_newton(const Newton::Settings& settings,
                                                  const Newton::Revise& revise, bool is_calm)
{
    newton_->set_problem({x_t1_, x_.device(), v_.device(), prediction_.device(), inertia_.view(),
                          fixed_.view(), dt_, active_});
    return Newton::minimise(*newton_, settings, revise, is_calm);
}

OuterLoop::Outcome DeviceBody::minimise(ActiveSetEnergy* active, int max_iterations, bool is_first)
{
    const bool in_contact = active && active->may_be_active();
    const OuterLoop::Outcome outcome =
        in_contact ? minimise_with_contact(*active->on_device(space_), max_iterations, is_first)
                   : minimise_free(is_first);
    parallel_for(space_, "pd/take", x_.size(), CopyItems<Vec3>{descent_->x(), x_t1_.overwrite_on_device()});
    return outcome;
}

/// Restarts without motion if that is better than the result, like Body.
OuterLoop::Outcome DeviceBody::minimise_free(bool is_first)
{
    const StageScope stage("pd/descend");
    const auto outcome_of = [](const Descent& found) {
        OuterLoop::Outcome outcome;
        outcome.iterations = found.iterations;
        outcome.converged = found.converged;
        outcome.displacement = found.displacement;
        outcome.value = found.search.value;
        return outcome;
    };
    const DescentFields fields = this->fields();
    if (!is_first)
        parallel_for(space_, "pd/begin_again", 1, BeginAgain{fields.descent, asked_.tolerance});
    begin_at(x_t1_.device());
    const Descent found = descent_->run();
    if (is_first)
        asked_ = found;
    const OuterLoop::Outcome first = outcome_of(found);
    if (!is_first || found.search.value <= found.standing_inertia)
        return first;

    keep_found();
    stand_still();
    parallel_for(space_, "pd/begin_again", 1,
                 BeginAgain{fields.descent, StepTolerance::kStanding * found.tolerance});
    Descent again = descent_->run_briefly();
    if (found.search.value <= again.start_value || !is_finite(again.start_value)) {
        take_found();
        return first;
    }
    if (!again.is_over)
        again = descent_->run();
    OuterLoop::Outcome outcome = outcome_of(again);
    outcome.iterations += found.iterations;
    return outcome;
}

/// Minimises while contact may be active.
OuterLoop::Outcome DeviceBody::minimise_with_contact(DeviceActiveSet& contact, int limit, bool is_first)
{
    const StageScope stage("pd/descend");
    prepare_contact();
    if (is_first)
        asked_ = descent_->state();
    OuterLoop::Settings settings{asked_.tolerance, limit};
    begin_at(x_t1_.device());
    const OuterLoop::Outcome found =
        run_with_contact(contact, settings, contact_descent_->evaluate(fields(), contact));
    if (!is_first || found.value <= asked_.standing_inertia)
        return found;

    stand_still();
    const double value = contact_descent_->evaluate(fields(), contact);
    if (found.value <= value || !is_finite(value))
        return found;
    settings.tolerance *= StepTolerance::kStanding;
    OuterLoop::Outcome outcome = run_with_contact(contact, settings, value);
    outcome.iterations += found.iterations;
    outcome.linear_iterations += found.linear_iterations;
    return outcome;
}

/// Prepares the descent with contact, in the first step with contact terms.
void DeviceBody::prepare_contact()
{
    if (is_contact_prepared_)
        return;
    if (!contact_descent_)
        contact_descent_ = std::make_unique<DeviceContactDescent>(space_, x_.size(), settings_.contact_solve);
    contact_descent_->prepare(*system_, *solver_);
    contact_descent_->set_problem(problem());
    is_contact_prepared_ = true;
}

OuterLoop::Outcome DeviceBody::run_with_contact(DeviceActiveSet& contact, const OuterLoop::Settings& settings,
                                                double value)
{
    return contact_descent_->minimise(fields(), contact,
                                      {settings, settings_.stop, asked_.mass, asked_.driving, dt_}, value);
}

void DeviceBody::begin_at(View<const Vec3> x)
{
    parallel_for(space_, "pd/begin_at", x_.size(), BeginAt{x, fields()});
}

void DeviceBody::stand_still()
{
    const View<Vec3> standing = x_t1_.overwrite_on_device();
    parallel_for(space_, "pd/stand_still", x_.size(),
                 StandStill{x_.device(), prediction_.device(), fixed_.view(), standing});
    begin_at(standing);
}

void DeviceBody::keep_found()
{
    parallel_for(space_, "pd/keep_found", x_.size(),
                 CopyFound{descent_->x(), descent_->gradient(), found_.view(), found_gradient_.view()});
}

void DeviceBody::take_found()
{
    parallel_for(space_, "pd/take_found", x_.size(),
                 CopyFound{found_.view(), found_gradient_.view(), descent_->x(), descent_->gradient()});
}

} // namespace toile
