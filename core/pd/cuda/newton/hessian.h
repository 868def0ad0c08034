#pragma once

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/cuda/newton/hessian_kernels.h"
#include "core/pd/cuda/newton/hessian_pattern.h"

namespace toile {

/// Projected Hessian of a step on a GPU, in single precision: inertia and the curvature of the energies.
class DeviceHessian {
public:
    /// @param space, energies  borrowed
    DeviceHessian(const CudaSpace& space, const HessianPattern& pattern, DeviceEnergies& energies);

    /// Evaluates it at x [vertices]. Enqueued.
    /// @param inertia  [vertices] [N/m]
    void linearise(View<const Vec3> x, View<const double> inertia);

    SlicedHessian view();

private:
    HessianBlocks blocks();

    const CudaSpace& space_;
    DeviceEnergies& energies_;
    DeviceArray<int> first_block_, block_columns_, first_scalar_, scalar_columns_;
    DeviceArray<Floats<4>> first_part_, second_part_;
    DeviceArray<float> last_part_, constant_, scalars_;
    DeviceArray<double> sum_;
};

} // namespace toile
