#pragma once

#include <vector>

#include "core/compute/cuda/array.h"

namespace toile::test {

/// Allocates device memory until about so many bytes are free; freed with the returned arrays.
inline std::vector<DeviceArray<double>> take_all_but(std::size_t bytes, const CudaSpace& space)
{
    std::vector<DeviceArray<double>> taken;
    for (std::size_t chunk = std::size_t(1) << 33; chunk >= std::size_t(1) << 22; chunk /= 2)
        while (space.free_memory() > chunk + bytes)
            taken.emplace_back(space, "test/taken", int(chunk / sizeof(double)));
    return taken;
}

} // namespace toile::test
