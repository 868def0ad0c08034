#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"

/// Construction of quadrature tables on a GPU, for real cloth.
namespace toile::research::gpu {

/// Comparison with the same table from the CPU.
struct CpuBuild {
    double seconds = 0.0;     ///< [s] on all threads
    int different_leaves = 0; ///< with other lists on the device: a cluster is at its limit
    double difference = 0.0;  ///< [-] maximum in the other leaves' weights, over the maximum weight
};

struct TableBuild {
    int vertices = 0;
    double factor_s = 0.0; ///< [s] factoring H, on the CPU
    double gpu_s = 0.0;    ///< [s] from the factor to the table in the device's memory
    double invert_s = 0.0; ///< [s] inverting the factor's blocks, on all threads of the CPU
    // Parts of gpu_s, measured with a wait after each [s].
    double solve_s = 0.0;   ///< columns of the inverse
    double moments_s = 0.0; ///< moments of clusters
    double lists_s = 0.0;   ///< lists and weights
    double table_mb = 0.0;  ///< [MB]
    double held_mb = 0.0;   ///< [MB] on the device at the end of the build, including the table

    std::optional<CpuBuild> cpu; ///< if the table was also built there
};

/// Builds tables of the sheet of measure_apply().
/// @param is_compared  builds them on the CPU too
TableBuild measure_build(const CudaSpace& space, int vertices, double stiffness, double dt, bool is_compared);

std::string markdown_of(const std::vector<TableBuild>& builds);
std::string csv_of(const std::vector<TableBuild>& builds);

} // namespace toile::research::gpu
