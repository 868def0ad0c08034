#pragma once

#include <string>
#include <vector>

#include "core/backend/cuda/device.h"

/// Pairs of a dress with the body in it on a GPU.
namespace toile::gpu {

struct ColliderSearch {
    std::string kinds; ///< of pairs that are looked for
    int vertices = 0, body_triangles = 0;
    int pairs = 0;
    double refit_us = 0.0;  ///< [us] boxes of body and cloth
    double planes_us = 0.0; ///< [us] vertices of the cloth look for planes
    double sheets_us = 0.0; ///< [us] vertices of the body look for cloth
    double ridges_us = 0.0; ///< [us] edges of the cloth look for ridges
    double report_us = 0.0; ///< [us] places and pairs
    double total_us = 0.0;  ///< [us] all of it
    double find_us = 0.0;   ///< [us] the same launched one by one, until the host knows the number
    double cpu_us = 0.0;    ///< [us] refit and ContactDetector on all threads of the CPU
    int different = 0;      ///< pairs whose numbers are not those of the CPU
};

/// Appends a dress of about so many vertices, 4 mm off the torso and straight below the hips, on the walking
/// mannequin in a step of 1/120 s: vertices only, and all kinds of pairs.
void measure_colliders(const CudaSpace& space, int vertices, std::vector<ColliderSearch>& out);

std::string markdown_of(const std::vector<ColliderSearch>& searches);
std::string csv_of(const std::vector<ColliderSearch>& searches);

} // namespace toile::gpu
