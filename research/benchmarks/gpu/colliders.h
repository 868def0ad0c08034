#pragma once

#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"

/// Search for pairs of a dress with the body in it on a GPU.
namespace toile::research::gpu {

struct ColliderSearch {
    std::string kinds; ///< of pairs in the search
    int vertices = 0, body_triangles = 0;
    int pairs = 0;
    double refit_us = 0.0;  ///< [us] boxes of body and cloth
    double planes_us = 0.0; ///< [us] query of planes by the cloth's vertices
    double sheets_us = 0.0; ///< [us] query of cloth by the body's vertices
    double ridges_us = 0.0; ///< [us] query of ridges by the cloth's edges
    double report_us = 0.0; ///< [us] slots and pairs
    double total_us = 0.0;  ///< [us] all of it
    double find_us = 0.0;   ///< [us] separate launches, until the host knows the number of pairs
    double cpu_us = 0.0;    ///< [us] refit and ContactDetector on all threads of the CPU
    int different = 0;      ///< pairs that differ from the CPU's
};

/// Appends measurements of a dress with about this many vertices on the walking mannequin, in a step of 1/120
/// s. It is 4 mm off the torso and straight below the hips. One measurement has vertex pairs only, one all
/// kinds of pairs.
void measure_colliders(const CudaSpace& space, int vertices, std::vector<ColliderSearch>& out);

std::string markdown_of(const std::vector<ColliderSearch>& searches);
std::string csv_of(const std::vector<ColliderSearch>& searches);

} // namespace toile::research::gpu
