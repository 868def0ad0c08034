#include "core/pd/point_masses.h"

#include "core/backend/parallel.h"
#include "core/pd/step_kernels.h"

namespace toile {

void PointMasses::predict(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                          View<const Vec3> targets, View<Vec3> prediction) const
{
    parallel_for(kCpu, "pd/predict", int(x_.size()),
                 PredictVertex{x_, v_, acceleration, fixed, targets, dt, prediction});
}

/// What the constraint moves becomes velocity: it is a force like any other.
void PointMasses::project(double dt, View<const unsigned char> fixed, StepProjection& projection,
                          const ActiveSetEnergy* active)
{
    const View<const double> masses = this->masses();
    inverse_masses_.resize(x_.size());
    for (int i = 0; i < int(x_.size()); ++i)
        inverse_masses_[i] = fixed[i] ? 0.0 : 1.0 / masses[i];
    unprojected_ = x_t1_;
    std::function<bool()> clear_contacts;
    if (active)
        clear_contacts = [&] { return active->make_feasible(x_t1_); };
    projection.project(x_t1_, inverse_masses_, clear_contacts);
    parallel_for(kCpu, "pd/finish", int(x_.size()),
                 [&](int i) { v_[i] += (x_t1_[i] - unprojected_[i]) / dt; });
}

} // namespace toile
