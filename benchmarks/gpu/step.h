#pragma once

#include "core/backend/cuda/device.h"

namespace toile::gpu {

/// Cloths of one body that swing freely: what is stepped.
struct StepCase {
    int cloths = 1;
    int vertices = 0;       ///< of each
    double stiffness = 0.0; ///< [N/m]
    double dt = 0.0;        ///< [s]
    int iterations = 42;    ///< of every step, neither more nor less
};

/// What whole steps without contact cost.
struct Step {
    int cloths = 0, vertices = 0;  ///< of each
    double iterations = 0.0;       ///< of a step, on average
    double device_ms = 0.0;        ///< median, from the call to its return
    double cpu_ms = 0.0;           ///< median of three steps with quadrature on all threads of the host
    double difference = 0.0;       ///< [m] largest between both after the first step, with equal weights
    double bytes_difference = 0.0; ///< [m] the same with a byte a weight, which is what is timed
};

Step measure_step(const CudaSpace& space, const StepCase& what);

} // namespace toile::gpu
