#include <cmath>

#include "core/backend/cuda/parallel.cuh"
#include "core/pd/device/device_body.h"

/// The two ends of a step: what it starts from, and what is told of where it has come to.
namespace toile {

void DeviceBody::overwrite(MirroredArray<Vec3>& field, View<const Vec3> values)
{
    TOILE_ASSERT(values.size() == field.size());
    std::copy(values.begin(), values.end(), field.overwrite_on_host().begin());
}

void DeviceBody::set_velocities(View<const Vec3> v)
{
    overwrite(v_, v);
    knows_speed_ = false;
}

double DeviceBody::max_speed() const
{
    return knows_speed_ ? std::sqrt(speed_[0].value) : PointMasses::max_speed();
}

std::shared_ptr<const Readback<Vec3>> DeviceBody::read_back_positions()
{
    const std::shared_ptr<Readback<Vec3>> readback = readbacks_.take();
    x_.read_back(*readback);
    return readback;
}

/// Takes note of which vertices are fixed, and of H.
void DeviceBody::hold(const std::vector<unsigned char>& fixed)
{
    fixed_.upload(fixed);
    std::vector<double> inverse_masses(fixed.size(), 0.0);
    host_held_.clear();
    for (int i = 0; i < int(fixed.size()); ++i)
        if (fixed[i])
            host_held_.push_back(i);
        else
            inverse_masses[i] = 1.0 / masses()[i];
    inverse_masses_.upload(inverse_masses);
    diagonal_.upload(system_->diagonal());
    held_.upload(host_held_);
    held_targets_on_host_.resize(held_.size());
}

void DeviceBody::begin_forces(View<const Vec3> acceleration)
{
    TOILE_ASSERT(acceleration.empty() == (loads_ != nullptr));
    knows_speed_ = false;
    if (loads_)
        loads_->accelerate(dt_, x_.there(), v_.there(), acceleration_.overwrite_there());
    else
        overwrite(acceleration_, acceleration);
}

void DeviceBody::begin_targets(View<const Vec3> targets)
{
    TOILE_ASSERT(targets.size() == x_.size());
    if (host_held_.empty())
        return;
    const View<Vec3> held = held_targets_on_host_.view();
    for (int k = 0; k < held.size(); ++k)
        held[k] = targets[host_held_[k]];
    held_targets_.upload(held);
    parallel_for(space_, "pd/place_targets", held.size(),
                 PlaceTarget{held_.view(), held_targets_.view(), targets_.view()});
}

/// Where everything would go alone, which is where the step begins; and tells the descent what is asked.
void DeviceBody::predict()
{
    const View<Vec3> prediction = prediction_.overwrite_there();
    const PredictVertex predict{x_.there(), v_.there(), acceleration_.there(), fixed_.view(), targets_.view(),
                                dt_,        prediction};
    parallel_sum_then(
        space_, "pd/predict", x_.size(), StepSums{}, BeginVertex{predict, masses_.view(), drive_.view()},
        BeginDescent{fields().descent, {settings_.tolerance}, settings_.stop, settings_.max_iterations, dt_},
        begin_sums_);
    parallel_for(space_, "pd/begin", x_.size(), CopyPositions{prediction, x_t1_.overwrite_there()});
}

void DeviceBody::finish()
{
    for (const auto& energy : energies_.all())
        energy->end_minimisation(x_t1_.there());
    parallel_sum(space_, "pd/finish", x_.size(), LargestSquare{},
                 FinishVertex{x_.there(), x_t1_.there(), descent_.gradient(), dt_, v_.overwrite_there()},
                 gradient_.view(), end_sums_);
}

/// Takes the end for the next start, and waits once for all that is reported of it.
void DeviceBody::end(DeviceStepProjection* limits, StepReport& report)
{
    parallel_sum(space_, "pd/end", x_.size(), LargestSquare{},
                 EndVertex{{x_t1_.there(), x_.overwrite_there()}, v_.there()}, speed_.view(), end_sums_);
    if (limits)
        limits->end_step(x_.there());
    space_.synchronise();
    knows_speed_ = true;
    report.gradient_norm = std::sqrt(gradient_[0].value);
}

} // namespace toile
