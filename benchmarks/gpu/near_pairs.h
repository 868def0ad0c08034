#pragma once

#include <string>
#include <vector>

#include "core/backend/cuda/device.h"

/// Near pairs of cloth with itself on a GPU.
namespace toile::gpu {

struct NearSearch {
    std::string scene;
    std::string order; ///< of the trees: chosen in the pose that is searched, or in the flat one
    int vertices = 0, triangles = 0;
    int pairs = 0, facing = 0;
    double refit_us = 0.0;     ///< [us] points and boxes
    double triangles_us = 0.0; ///< [us] vertices look for triangles
    double edges_us = 0.0;     ///< [us] edges look for edges
    double records_us = 0.0;   ///< [us] candidates sorted and tested, pairs reported
    double total_us = 0.0;     ///< [us] all of it
    double find_us = 0.0;      ///< [us] the same launched one by one, until the host knows the number
    double cpu_us = 0.0;       ///< [us] NearPairs::find on all threads of the CPU, searching
    int different = 0;         ///< pairs whose numbers or flag are not those of the CPU
};

/// Appends a square sheet of about so many vertices, folded in five layers one edge and 0.7 edges apart,
/// every vertex displaced at random; margin half an edge; at rest, and falling with every vertex on a way of
/// its own.
void measure_near_pairs(const CudaSpace& space, int vertices, std::vector<NearSearch>& out);

std::string markdown_of(const std::vector<NearSearch>& searches);
std::string csv_of(const std::vector<NearSearch>& searches);

} // namespace toile::gpu
