#include <algorithm>
#include <cmath>

#include "core/compute/copy_items.h"
#include "core/compute/cuda/parallel.cuh"
#include "core/pd/cuda/body.h"

/// Start and end of a step: its inputs, and the report on its result.
namespace toile {

void DeviceBody::overwrite(MirroredArray<Vec3>& field, View<const Vec3> values)
{
    TOILE_ASSERT(values.size() == field.size());
    std::copy(values.begin(), values.end(), field.overwrite_on_host().begin());
}

void DeviceBody::set_positions(View<const Vec3> x)
{
    overwrite(x_, x);
    restart_all();
}

void DeviceBody::set_velocities(View<const Vec3> v)
{
    overwrite(v_, v);
    restart_all();
    is_speed_current_ = false;
}

double DeviceBody::max_speed() const
{
    return is_speed_current_ ? std::sqrt(speed_[0].value) : PointMasses::max_speed();
}

std::shared_ptr<const Readback<Vec3>> DeviceBody::read_back_positions()
{
    const std::shared_ptr<Readback<Vec3>> readback = readbacks_.take();
    x_.read_back(*readback);
    return readback;
}

/// Takes other fixed vertices.
void DeviceBody::set_fixed(const std::vector<unsigned char>& fixed)
{
    fixed_.upload(fixed);
    std::vector<double> inverse_masses(fixed.size(), 0.0);
    fixed_vertices_on_host_.clear();
    for (int i = 0; i < int(fixed.size()); ++i)
        if (fixed[i])
            fixed_vertices_on_host_.push_back(i);
        else
            inverse_masses[i] = 1.0 / masses()[i];
    inverse_masses_.upload(inverse_masses);
    fixed_vertices_.upload(fixed_vertices_on_host_);
    fixed_targets_on_host_.resize(fixed_vertices_.size());
    if (newton_)
        newton_->set_fixed(fixed);
    host_fixed_ = fixed;
}

void DeviceBody::begin_forces(View<const Vec3> acceleration)
{
    TOILE_ASSERT(acceleration.empty() == (loads_ != nullptr));
    is_speed_current_ = false;
    if (loads_)
        loads_->accelerate(dt_, x_.device(), v_.device(), acceleration_.overwrite_on_device());
    else
        overwrite(acceleration_, acceleration);
}

void DeviceBody::begin_targets(View<const Vec3> targets)
{
    TOILE_ASSERT(targets.size() == x_.size());
    if (fixed_vertices_on_host_.empty())
        return;
    const View<Vec3> staged = fixed_targets_on_host_.view();
    for (int k = 0; k < staged.size(); ++k)
        staged[k] = targets[fixed_vertices_on_host_[k]];
    fixed_targets_.upload(staged);
    parallel_for(space_, "pd/scatter_targets", staged.size(),
                 ScatterTarget{fixed_vertices_.view(), fixed_targets_.view(), targets_.view()});
}

MotionView DeviceBody::motion()
{
    return {x_.change_on_device(), v_.change_on_device(), x_previous_.view(),  v_previous_.view(),
            restart_.view(),       touched_.view(),       touches_.view(),     fixed_.view(),
            stiff_part_.view(),    part_touched_.view(),  part_touches_.view()};
}

/// Begins the motion anew everywhere.
void DeviceBody::restart_all() { restart_.upload(std::vector<unsigned char>(x_.size(), 1)); }

/// Predicts all vertices, and guesses the end of the step.
void DeviceBody::predict()
{
    predict_motion();
    if (newton_)
        parallel_for(space_, "pd/guess", x_.size(),
                     GuessByVelocity{x_.device(), v_.device(), prediction_.device(), fixed_.view(), dt_,
                                     x_t1_.overwrite_on_device()});
    else
        parallel_for(space_, "pd/begin", x_.size(),
                     CopyItems<Vec3>{prediction_.device(), x_t1_.overwrite_on_device()});
}

/// Predicts all vertices, and writes the inputs to the descent.
void DeviceBody::predict_motion()
{
    const PredictMotion predict{scheme_,         motion(),       acceleration_.device(),
                                targets_.view(), masses_.view(), prediction_.overwrite_on_device(),
                                inertia_.view()};
    if (newton_)
        return parallel_for(space_, "pd/predict", x_.size(), predict);
    parallel_sum_then(space_, "pd/predict", x_.size(), StepSums{}, BeginVertex{predict, drive_.view()},
                      BeginDescent{fields().descent,
                                   {settings_.tolerance},
                                   settings_.stop,
                                   settings_.max_iterations,
                                   scheme_.implicit_step()},
                      begin_sums_);
}

void DeviceBody::mark_touching(ActiveSetEnergy& active)
{
    if (settings_.integrator == Integrator::ImplicitEuler)
        return;
    active.mark_touching(x_t1_, touches_.view());
    if (stiff_part_.size() > 0)
        parallel_for(space_, "pd/mark_parts", stiff_part_.size(), MarkPart{motion()});
}

void DeviceBody::set_stiff_parts(const std::vector<int>& of_vertex)
{
    stiff_part_.upload(of_vertex);
    for (DeviceArray<unsigned char>* marks : {&part_touched_, &part_touches_}) {
        marks->resize(1 + *std::max_element(of_vertex.begin(), of_vertex.end()));
        marks->fill_zero();
    }
}

void DeviceBody::begin_anew()
{
    previous_dt_ = 0.0;
    touched_.fill_zero();
}

void DeviceBody::forget_touching()
{
    touches_.fill_zero();
    if (stiff_part_.size() > 0)
        for (DeviceArray<unsigned char>* marks : {&part_touched_, &part_touches_})
            marks->fill_zero();
}

double DeviceBody::local_error()
{
    return parallel_sum(space_, "pd/error", x_.size(), StepErrorSum{},
                        MotionError{scheme_, motion(), x_t1_.device(), previous_dt_ == 0.0}, error_sums_)
        .rms();
}

void DeviceBody::abandon()
{
    parallel_for(space_, "pd/abandon", restart_.size(),
                 CopyItems<unsigned char>{restart_before_.view(), restart_.view()});
    forget_touching();
}

void DeviceBody::finish(StepProjection*)
{
    for (const auto& energy : energies_.all())
        energy->end_minimisation(x_t1_.device());
    parallel_sum(space_, "pd/finish", x_.size(), FinishSums{},
                 FinishVertex{{scheme_, motion(), x_t1_.device(), previous_dt_ == 0.0},
                              newton_ ? newton_->gradient() : descent_->gradient(),
                              minimiser_.view()},
                 finished_.view(), finish_sums_);
}

/// Waits once for all numbers of the report.
void DeviceBody::end(StepProjection* projection, StepReport& report)
{
    parallel_sum(space_, "pd/end", x_.size(), LargestSquare{},
                 EndVertex{{motion(), minimiser_.view(), x_t1_.device()}}, speed_.view(), end_sums_);
    forget_touching();
    previous_dt_ = dt_;
    if (projection)
        projection->on_device(space_)->end_step(x_.device());
    space_.synchronise();
    is_speed_current_ = true;
    report.gradient_norm = std::sqrt(finished_[0].gradient.value);
    report.step_error = finished_[0].error.rms();
}

} // namespace toile
