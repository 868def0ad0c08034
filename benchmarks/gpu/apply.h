#pragma once

#include "core/backend/cuda/device.h"

/// The global solve by quadrature on a GPU, with the weights of real cloth.
namespace toile::gpu {

struct Apply {
    int vertices = 0;
    double gathers = 0.0;    ///< table entries that a vertex reads
    double table_mb = 0.0;   ///< [MB]
    double build_s = 0.0;    ///< [s] of the tables, on all threads of the CPU
    double cpu_us = 0.0;     ///< the same solve on all threads of the CPU [us]
    double moments_us = 0.0; ///< [us] first pass
    double gather_us = 0.0;  ///< [us] second pass
    double solve_us = 0.0;   ///< [us] both
    double difference = 0.0; ///< [-] largest, between the CPU's result and this, of the largest number
};

/// A square metre of cloth with bending, held at two corners.
/// @param stiffness  of warp and weft [N/m]
Apply measure_apply(const CudaSpace& space, int vertices, double stiffness, double dt);

/// Bytes read and written per second when two arrays of `megabytes` each are copied by a kernel [GB/s].
double copy_bandwidth(const CudaSpace& space, int megabytes);

} // namespace toile::gpu
