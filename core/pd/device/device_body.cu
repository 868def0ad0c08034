#include "core/pd/device/device_body.h"

#include <cmath>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/error.h"

namespace toile {

namespace {

DeviceSolver* device_solver_of(System& system)
{
    auto* solver = dynamic_cast<DeviceSolver*>(&system.solver());
    if (solver == nullptr)
        throw InvalidInput("this global solver does not run on a GPU; quadrature does");
    return solver;
}

} // namespace

DeviceBody::DeviceBody(const CudaSpace& space, const std::vector<Vec3>& positions,
                       std::unique_ptr<System> system, Settings settings)
    : space_(space), system_(std::move(system)), solver_(device_solver_of(*system_)), settings_(settings),
      energies_(space), x_(space, "body/x"), v_(space, "body/v", int(positions.size())),
      acceleration_(space, "body/acceleration", int(positions.size())),
      targets_(space, "body/targets", int(positions.size())),
      prediction_(space, "body/prediction", int(positions.size())),
      drive_(space, "body/drive", int(positions.size())), found_(space, "body/found", int(positions.size())),
      masses_(space, "body/masses"), fixed_(space, "body/fixed"),
      begin_sums_(space, "body/begin_sums", block_count(int(positions.size()), kSumItems)),
      finish_sums_(space, "body/finish_sums", block_count(int(positions.size()), kSumItems)),
      finish_(space, "body/finish", 1), finish_on_host_(space, "body/finish_on_host", 1),
      descent_(space, int(positions.size()))
{
    for (const auto& energy : system_->energies())
        if (!energy->add_to(energies_, 0))
            throw InvalidInput(std::string(energy->name()) + " does not run on a GPU");
    x_.upload(positions);
    masses_.upload(system_->masses());
    for (DeviceArray<Vec3>* field : {&v_, &acceleration_, &targets_})
        field->fill_zero();
}

void DeviceBody::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    const bool is_new = dt != dt_ || fixed != host_fixed_;
    dt_ = 0.0; // not prepared, should the solver refuse H
    system_->prepare(dt, fixed);
    if (is_new) {
        host_fixed_ = fixed;
        fixed_.upload(fixed);
    }
    dt_ = dt;
    if (is_new)
        descent_.record(problem());
}

DeviceDescent::Problem DeviceBody::problem()
{
    return {[this](const DeviceEvaluation& at) {
                for (const auto& energy : energies_.all())
                    energy->add_gradient(at);
            },
            [this](View<const Vec3> g, View<Vec3> z) { solver_->solve_there(g, z); },
            masses_.view(),
            fixed_.view(),
            prediction_.view(),
            drive_.view(),
            dt_};
}

/// Predicts, and tells the descent what is asked.
void DeviceBody::begin()
{
    const PredictVertex predict{x_.view(),       v_.view(), acceleration_.view(), fixed_.view(),
                                targets_.view(), dt_,       prediction_.view()};
    const DescentFields fields = descent_.fields(problem());
    parallel_sum_then(
        space_, "pd/predict", x_.size(), StepSums{}, BeginVertex{predict, drive_.view(), fields},
        BeginDescent{fields.descent, {settings_.tolerance}, settings_.max_iterations, dt_}, begin_sums_);
}

StepReport DeviceBody::step(double dt, const std::vector<unsigned char>& fixed)
{
    const StageScope stage("pd/device_step");
    prepare(dt, fixed);
    for (const auto& energy : energies_.all())
        energy->begin_step();
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
    if (!(found.search.value > inertia))
        return found;
    const DescentFields fields = descent_.fields(problem());
    parallel_for(space_, "pd/keep_found", x_.size(), CopyPositions{descent_.x(), found_.view()});
    parallel_for(space_, "pd/stand_still", x_.size(), StandStill{x_.view(), prediction_.view(), fields});
    parallel_for(space_, "pd/begin_again", 1,
                 BeginAgain{fields.descent, StepTolerance::kStanding * found.tolerance});
    Descent outcome = descent_.run_briefly();
    if (!(outcome.start_value < found.search.value)) {
        parallel_for(space_, "pd/take_found", x_.size(), CopyPositions{found_.view(), descent_.x()});
        return found;
    }
    if (!outcome.is_over)
        outcome = descent_.run();
    outcome.iterations += found.iterations;
    return outcome;
}

void DeviceBody::finish(StepReport& report)
{
    parallel_sum(space_, "pd/finish", x_.size(), FinishSums{},
                 FinishVertex{descent_.x(), descent_.gradient(), dt_, x_.view(), v_.view()}, finish_.view(),
                 finish_sums_);
    finish_.download(finish_on_host_.view());
    space_.synchronise();
    report.gradient_norm = std::sqrt(finish_on_host_[0].gradient_square);
}

} // namespace toile
