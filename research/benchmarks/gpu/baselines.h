#pragma once

#include <vector>

#include "core/compute/cuda/runtime/device.h"
#include "research/benchmarks/solvers/run.h"

namespace toile::research::gpu {

/// A sheet that swings from two corners, and the sampling of its motion.
struct BaselinesCase {
    int vertices = 0;
    double stiffness = 0.0; ///< [N/m]
    double dt = 0.0;        ///< [s]
    int steps = 0;          ///< sampled
    int stride = 0;         ///< steps between samples
};

/// Measures our step and the baselines, all on the GPU, from equal states. Each method and budget has a
/// result against the converged minimisers of the steps ("sheet"). If its budget is a number of steps, it has
/// another against the limit of ever smaller steps ("sheet in small steps", without energies). Times are
/// medians of steps after the sampled one, from the call to its return; they include copies of forces and
/// targets, the only data that the host writes. peak_mb is the method's memory on the device. Runs that
/// explode are omitted.
std::vector<solvers::Result> measure_baselines(const CudaSpace& space, const BaselinesCase& what);

} // namespace toile::research::gpu
