#pragma once

#include "core/compute/cuda/runtime/device.h"

/// The global solve by quadrature on a GPU, with the weights of real cloth.
namespace toile::research::gpu {

struct Apply {
    int vertices = 0;
    double gathers = 0.0;    ///< table entries that a vertex reads
    double table_mb = 0.0;   ///< [MB]
    double build_s = 0.0;    ///< [s] of the tables, on all threads of the CPU
    double cpu_us = 0.0;     ///< solve on all threads of the CPU [us]
    double moments_us = 0.0; ///< [us] first pass
    double gather_us = 0.0;  ///< [us] second pass
    double solve_us = 0.0;   ///< [us] both
    double difference = 0.0; ///< [-] maximum difference between CPU and GPU, over the maximum value
};

/// Measures a square metre of cloth with bending, attached at two corners.
/// @param stiffness  of warp and weft [N/m]
Apply measure_apply(const CudaSpace& space, int vertices, double stiffness, double dt);

/// Bandwidth, read plus written, of a kernel that copies between two arrays of `megabytes` each [GB/s].
double copy_bandwidth(const CudaSpace& space, int megabytes);

} // namespace toile::research::gpu
