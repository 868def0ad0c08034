#pragma once

#include <optional>

#include "core/backend/cuda/device.h"

/// Building the tables of quadrature on a GPU, for real cloth.
namespace toile::gpu {

struct TableBuild {
    int vertices = 0;
    double factor_s = 0.0; ///< [s] of H, on the CPU
    double gpu_s = 0.0;    ///< [s] from the factor to the table in the device's memory
    double invert_s = 0.0; ///< [s] of it: inverting the factor's blocks, on all threads of the CPU
    // Parts of it when the device is waited for after each [s].
    double solve_s = 0.0;   ///< columns of the inverse
    double moments_s = 0.0; ///< what clusters carry of them
    double lists_s = 0.0;   ///< lists and weights
    double table_mb = 0.0;  ///< [MB]
    double peak_mb = 0.0;   ///< [MB] on the device while it is built, table included

    /// The CPU's, where it was built there too.
    struct OnCpu {
        double seconds = 0.0;     ///< [s] on all threads
        int different_leaves = 0; ///< of which the device has other lists: a cluster is at its limit
        double difference = 0.0;  ///< [-] largest of the other leaves' weights, of the largest weight
    };
    std::optional<OnCpu> cpu;
};

/// Tables of the sheet of measure_apply.
/// @param is_compared  builds them on the CPU too
TableBuild measure_build(const CudaSpace& space, int vertices, double stiffness, double dt, bool is_compared);

} // namespace toile::gpu
