#pragma once

#include <vector>

#include "benchmarks/solvers/run.h"
#include "core/backend/cuda/device.h"

namespace toile::gpu {

/// A sheet that swings from two corners, and how much of its motion is sampled.
struct RivalsCase {
    int vertices = 0;
    double stiffness = 0.0; ///< [N/m]
    double dt = 0.0;        ///< [s]
    int steps = 0;          ///< sampled
    int stride = 0;         ///< steps between samples
};

/// Our step and other people's, all on the GPU, from the same states: a result per method and budget against
/// the converged minimisers of the steps ("sheet"), and one against the limit of ever smaller steps ("sheet
/// in small steps", without energies) for those whose budget is a number of steps. Times are medians of
/// steps, from the call to its return, after the sampled one; nothing that the host writes but forces and
/// targets is copied in them. peak_mb is what the method holds on the device. Runs that explode are left out.
std::vector<solvers::Result> measure_rivals(const CudaSpace& space, const RivalsCase& what);

} // namespace toile::gpu
