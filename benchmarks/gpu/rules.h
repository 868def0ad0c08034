#pragma once

#include <string>
#include <vector>

#include "core/backend/cuda/device.h"

namespace toile::gpu {

/// One application of a global solver on a GPU.
struct RuleApply {
    std::string name;
    int vertices = 0;
    double solve_us = 0.0;     ///< [us]
    double smooth_error = 0.0; ///< [-] |x - H^-1 b| / |H^-1 b| for the inertia of a smooth wave
    double rough_error = 0.0;  ///< [-] the same for a load of all wavelengths
};

/// Ours and other people's global solvers, the paper's rule among them, on a square metre of cloth with
/// bending, held at two corners.
/// @param vertices    at most solvers::kPaperSize
/// @param stiffness   of warp and weft [N/m]
/// @param rules       appended to
void measure_rules(const CudaSpace& space, int vertices, double stiffness, double dt,
                   std::vector<RuleApply>& rules);

std::string markdown_of(const std::vector<RuleApply>& rules);
std::string csv_of(const std::vector<RuleApply>& rules);

} // namespace toile::gpu
