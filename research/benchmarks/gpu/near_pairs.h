#pragma once

#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"

/// Search for near pairs of cloth with itself on a GPU.
namespace toile::research::gpu {

struct NearSearch {
    std::string scene;
    std::string order; ///< of the trees: from the searched pose, or from the flat one
    int vertices = 0, triangles = 0;
    int pairs = 0, facing = 0;
    double refit_us = 0.0;     ///< [us] points and boxes
    double triangles_us = 0.0; ///< [us] query of triangles by vertices
    double edges_us = 0.0;     ///< [us] query of edges by edges
    double records_us = 0.0;   ///< [us] candidates sorted and tested, pairs reported
    double total_us = 0.0;     ///< [us] all of it
    double find_us = 0.0;      ///< [us] separate launches, until the host knows the number of pairs
    double cpu_us = 0.0;       ///< [us] NearPairs::find on all threads of the CPU, searching
    int different = 0;         ///< pairs whose indices or flag differ from the CPU's
};

/// Appends measurements of a square sheet with about this many vertices. It is folded into five layers one
/// edge and 0.7 edges apart, with random offsets of its vertices and a margin of half an edge. It is measured
/// at rest, and falling with a random displacement of every vertex.
void measure_near_pairs(const CudaSpace& space, int vertices, std::vector<NearSearch>& out);

std::string markdown_of(const std::vector<NearSearch>& searches);
std::string csv_of(const std::vector<NearSearch>& searches);

} // namespace toile::research::gpu
