#pragma once

#include <vector>

#include "core/backend/cuda/array.h"

namespace toile::test {

/// Leaves so many bytes of a device free, or a little more, while what it returns lives.
inline std::vector<DeviceArray<double>> take_all_but(std::size_t bytes, const CudaSpace& space)
{
    std::vector<DeviceArray<double>> taken;
    for (std::size_t chunk = std::size_t(1) << 33; chunk >= std::size_t(1) << 22; chunk /= 2)
        while (space.free_memory() > chunk + bytes)
            taken.emplace_back(space, "test/taken", int(chunk / sizeof(double)));
    return taken;
}

} // namespace toile::test
