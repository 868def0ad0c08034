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

} // namespace toile
