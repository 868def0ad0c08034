#pragma once

#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"

namespace toile::research::gpu {

/// One application of a global solver on a GPU.
struct RuleApply {
    std::string name;
    int vertices = 0;
    double solve_us = 0.0;     ///< [us]
    double smooth_error = 0.0; ///< [-] |x - H^-1 b| / |H^-1 b| for the inertia of a smooth wave
    double rough_error = 0.0;  ///< [-] for a load of all wavelengths
};

/// Measures our global solver and the baselines, the paper's rule among them, on a square metre of cloth with
/// bending, attached at two corners.
/// @param vertices    at most solvers::kPaperSize
/// @param stiffness   of warp and weft [N/m]
/// @param rules       appended to
void measure_rules(const CudaSpace& space, int vertices, double stiffness, double dt,
                   std::vector<RuleApply>& rules);

std::string markdown_of(const std::vector<RuleApply>& rules);
std::string csv_of(const std::vector<RuleApply>& rules);

} // namespace toile::research::gpu
