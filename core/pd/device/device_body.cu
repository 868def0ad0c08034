#include "core/pd/device/device_body.h"

#include <cmath>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/error.h"

namespace toile {

namespace {

DeviceSolver* device_solver_of(System& system, const CudaSpace& space)
{
    auto* solver = dynamic_cast<DeviceSolver*>(&system.solver());
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
      settings_(settings), energies_(energies_of(space, *system_)), x_(space, "body/x"),
      v_(space, "body/v", int(positions.size())),
      acceleration_(space, "body/acceleration", int(positions.size())),
      targets_(space, "body/targets", int(positions.size())),
      prediction_(space, "body/prediction", int(positions.size())),
      drive_(space, "body/drive", int(positions.size())), found_(space, "body/found", int(positions.size())),
      found_gradient_(space, "body/found_gradient", int(positions.size())), masses_(space, "body/masses"),
      fixed_(space, "body/fixed"),
      begin_sums_(space, "body/begin_sums", block_count(int(positions.size()), kSumItems)),
      finish_sums_(space, "body/finish_sums", block_count(int(positions.size()), kSumItems)),
      finish_(space, "body/finish", 1), finish_on_host_(space, "body/finish_on_host", 1),
      descent_(space, int(positions.size()), energies_.share_count())
{
    TOILE_ASSERT(int(positions.size()) == system_->vertex_count());
    x_.upload(positions);
    targets_.upload(positions);
    masses_.upload(system_->masses());
    v_.fill_zero();
    acceleration_.fill_zero();
}

void DeviceBody::set_acceleration(View<const Vec3> acceleration)
{
    TOILE_ASSERT(acceleration.size() == x_.size());
    acceleration_.upload(acceleration);
}

void DeviceBody::set_targets(View<const Vec3> targets)
{
    TOILE_ASSERT(targets.size() == x_.size());
    targets_.upload(targets);
}

void DeviceBody::set_positions(View<const Vec3> x)
{
    TOILE_ASSERT(x.size() == x_.size());
    x_.upload(x);
}

void DeviceBody::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    TOILE_ASSERT(int(fixed.size()) == x_.size());
    const bool is_new = dt != dt_ || fixed != host_fixed_;
    dt_ = 0.0; // not prepared, should the solver refuse H
    system_->prepare(dt, fixed);
    if (is_new) {
        fixed_.upload(fixed);
        descent_.record(problem(dt));
        host_fixed_ = fixed;
    }
    dt_ = dt;
}

DeviceDescent::Problem DeviceBody::problem(double dt)
{
    return {[this](const DeviceEvaluation& at) { energies_.add_gradient(at); },
            [this](View<const Vec3> g, View<Vec3> z) { solver_->solve_there(g, z); },
            masses_.view(),
            fixed_.view(),
            prediction_.view(),
            drive_.view(),
            dt};
}

/// Predicts, and tells the descent what is asked.
void DeviceBody::begin()
{
    const PredictVertex predict{x_.view(),       v_.view(), acceleration_.view(), fixed_.view(),
                                targets_.view(), dt_,       prediction_.view()};
    const DescentFields fields = descent_.fields(problem(dt_));
    parallel_sum_then(
        space_, "pd/predict", x_.size(), StepSums{}, BeginVertex{predict, drive_.view(), fields},
        BeginDescent{fields.descent, {settings_.tolerance}, settings_.max_iterations, dt_}, begin_sums_);
}

StepReport DeviceBody::step(double dt, const std::vector<unsigned char>& fixed)
{
    const StageScope stage("pd/device_step");
    prepare(dt, fixed);
    for (const auto& energy : energies_.all())
        energy->begin_step(x_.view());
    begin();

    StepReport report;
    report.steps = 1;
    const Descent outcome = no_worse_than_standing(descent_.run());
    report.iterations = outcome.iterations;
    report.displacement = outcome.displacement;
    report.energy = outcome.search.value;
    report.status = outcome.converged ? StepReport::Status::Converged : StepReport::Status::IterationLimit;
    if (!std::isfinite(outcome.start_value)) {
        report.status = StepReport::Status::NonFinite;
        report.message = "the energy at the start of the step is not finite";
        return report;
    }
    finish(report);
    return report;
}

/// As Body's: begins again where the cloth stands where that is better than what was found.
Descent DeviceBody::no_worse_than_standing(Descent found)
{
    const double inertia = 0.5 / found.dt2 * found.driving;
    if (found.search.value <= inertia)
        return found;
    const DescentFields fields = descent_.fields(problem(dt_));
    parallel_for(space_, "pd/keep_found", x_.size(),
                 CopyFound{descent_.x(), descent_.gradient(), found_.view(), found_gradient_.view()});
    parallel_for(space_, "pd/stand_still", x_.size(), StandStill{x_.view(), prediction_.view(), fields});
    parallel_for(space_, "pd/begin_again", 1,
                 BeginAgain{fields.descent, StepTolerance::kStanding * found.tolerance});
    Descent outcome = descent_.run_briefly();
    if (found.search.value <= outcome.start_value || !std::isfinite(outcome.start_value)) {
        parallel_for(space_, "pd/take_found", x_.size(),
                     CopyFound{found_.view(), found_gradient_.view(), descent_.x(), descent_.gradient()});
        return found;
    }
    if (!outcome.is_over)
        outcome = descent_.run();
    outcome.iterations += found.iterations;
    return outcome;
}

void DeviceBody::finish(StepReport& report)
{
    for (const auto& energy : energies_.all())
        energy->end_minimisation(descent_.x());
    parallel_sum(space_, "pd/finish", x_.size(), FinishSums{},
                 FinishVertex{descent_.x(), descent_.gradient(), dt_, x_.view(), v_.view()}, finish_.view(),
                 finish_sums_);
    finish_.download(finish_on_host_.view());
    space_.synchronise();
    report.gradient_norm = std::sqrt(finish_on_host_[0].gradient_square);
}

} // namespace toile
