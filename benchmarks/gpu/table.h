#pragma once

#include <string>
#include <vector>

#include "benchmarks/gpu/apply.h"

namespace toile::gpu {

/// What a run measured, and on what.
struct Report {
    CudaDevice device;
    double copy_gbs = 0.0;       ///< [GB/s] read and written, of arrays that no cache holds
    double small_copy_gbs = 0.0; ///< of arrays that the L2 cache holds
    std::vector<Apply> applies;
};

std::string markdown_tables(const Report& report);
std::string csv_of_applies(const Report& report);

} // namespace toile::gpu
