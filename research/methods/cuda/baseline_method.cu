#include "research/methods/cuda/baseline_method.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/compute/cuda/parallel.cuh"
#include "research/methods/baseline_kernels.h"

namespace toile::research {

DeviceBaselineMethod::DeviceBaselineMethod(const CudaSpace& space, const std::vector<Vec3>& positions,
                                           std::vector<double> masses)
    : space_(space), masses_(std::move(masses)), x_(space, "baseline_method/x", int(positions.size())),
      v_(space, "baseline_method/v", x_.size()),
      acceleration_(space, "baseline_method/acceleration", x_.size()),
      targets_(space, "baseline_method/targets", x_.size()),
      mobility_(space, "baseline_method/mobility", x_.size()), lost_(space, "baseline_method/lost", 1),
      lost_sums_(space, "baseline_method/lost_sums", block_count(x_.size(), kSumItems)),
      lost_on_host_(space, "baseline_method/lost_on_host", 1), step_(space, "baseline_method/step")
{
    set_positions(positions);
    set_velocities(std::vector<Vec3>(positions.size(), Vec3::Zero()));
}

void DeviceBaselineMethod::overwrite(MirroredArray<Vec3>& field, View<const Vec3> values)
{
    TOILE_ASSERT(values.size() == field.size());
    std::copy(values.begin(), values.end(), field.overwrite_on_host().begin());
}

/// Fields on the device. Uploads host changes now, so that the recording contains no copy.
DeviceBaselineMethod::Fields DeviceBaselineMethod::fields()
{
    return {x_.change_on_device(), v_.change_on_device(), acceleration_.device(), targets_.device(),
            mobility_.view()};
}

void DeviceBaselineMethod::prepare(double dt, const std::vector<unsigned char>& fixed)
{
    TOILE_ASSERT(int(fixed.size()) == x_.size());
    if (fixed != host_fixed_) {
        std::vector<double> mobility(fixed.size(), 0.0);
        for (size_t i = 0; i < fixed.size(); ++i)
            if (!fixed[i])
                mobility[i] = 1.0 / masses_[i];
        mobility_.upload(mobility);
        host_fixed_ = fixed;
    }
    if (dt == dt_)
        return;
    const Fields fields = this->fields();
    step_.record([&] {
        enqueue(dt, fields);
        parallel_sum(space_, "baseline_method/lost", x_.size(), 0, CountLost{fields.x}, lost_.view(),
                     lost_sums_);
        lost_.download(lost_on_host_.view());
    });
    dt_ = dt;
}

StepReport DeviceBaselineMethod::step(double dt, View<const Vec3> acceleration,
                                      const std::vector<unsigned char>& fixed, View<const Vec3> targets,
                                      ActiveSetEnergy* active, StepProjection* projection)
{
    const StageScope stage("baseline_method/device_step");
    if (active || projection)
        throw InvalidInput("this baseline method knows neither contact nor limits on a GPU");
    overwrite(acceleration_, acceleration);
    overwrite(targets_, targets);
    prepare(dt, fixed);
    static_cast<void>(fields());
    step_.launch();
    space_.synchronise();

    StepReport report;
    report.steps = 1;
    report.iterations = iterations();
    report.status = StepReport::Status::IterationLimit;
    if (lost_on_host_[0] > 0) {
        report.status = StepReport::Status::NonFinite;
        report.message = std::to_string(lost_on_host_[0]) + " positions are not finite";
    }
    return report;
}

} // namespace toile::research
