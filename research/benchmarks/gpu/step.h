#pragma once

#include "core/compute/cuda/runtime/device.h"

namespace toile::research::gpu {

/// Freely swinging cloths of one body.
struct StepCase {
    int cloths = 1;
    int vertices = 0;       ///< of each
    double stiffness = 0.0; ///< [N/m]
    double dt = 0.0;        ///< [s]
    int iterations = 42;    ///< of every step, exactly
};

/// Cost of whole steps without contact.
struct Step {
    int cloths = 0, vertices = 0; ///< of each
    double iterations = 0.0;      ///< per step, mean
    double device_ms = 0.0;       ///< median, from the call to its return
    double cpu_ms = 0.0;          ///< median of three steps with quadrature on all threads of the host
    double difference = 0.0; ///< [m] maximum difference between both after the first step, with equal weights
    double bytes_difference = 0.0; ///< [m] the same with one byte per weight, as timed
};

Step measure_step(const CudaSpace& space, const StepCase& what);

} // namespace toile::research::gpu
