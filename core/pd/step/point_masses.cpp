#include "core/pd/step/point_masses.h"

#include "core/compute/parallel.h"
#include "core/pd/step/step_kernels.h"

namespace toile {

void PointMassesOnHost::predict(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                                View<const Vec3> targets, View<Vec3> prediction) const
{
    parallel_for(kCpu, "pd/predict", int(x_.size()),
                 PredictVertex{x_, v_, acceleration, fixed, targets, dt, prediction});
}

void PointMassesOnHost::project(StepProjection& projection, double dt, View<const double> masses,
                                View<const unsigned char> fixed, const std::function<bool()>& clear_contacts)
{
    inverse_masses_.resize(x_t1_.size());
    for (int i = 0; i < int(x_t1_.size()); ++i)
        inverse_masses_[i] = fixed[i] ? 0.0 : 1.0 / masses[i];
    unprojected_ = x_t1_;
    projection.project(x_t1_, inverse_masses_, clear_contacts);
    parallel_for(kCpu, "pd/finish", int(x_t1_.size()),
                 [&](int i) { v_[i] += (x_t1_[i] - unprojected_[i]) / dt; });
}

} // namespace toile
