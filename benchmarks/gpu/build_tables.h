#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/backend/cuda/device.h"

/// Building the tables of quadrature on a GPU, for real cloth.
namespace toile::gpu {

/// The same table from the CPU.
struct CpuBuild {
    double seconds = 0.0;     ///< [s] on all threads
    int different_leaves = 0; ///< of which the device has other lists: a cluster is at its limit
    double difference = 0.0;  ///< [-] largest of the other leaves' weights, of the largest weight
};

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
    double held_mb = 0.0;   ///< [MB] on the device at the end of the build, table included

    std::optional<CpuBuild> cpu; ///< where it was built there too
};

/// Tables of the sheet of measure_apply.
/// @param is_compared  builds them on the CPU too
TableBuild measure_build(const CudaSpace& space, int vertices, double stiffness, double dt, bool is_compared);

std::string markdown_of(const std::vector<TableBuild>& builds);
std::string csv_of(const std::vector<TableBuild>& builds);

} // namespace toile::gpu
