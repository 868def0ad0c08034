#pragma once

#include <cmath>
#include <vector>

#include "core/compute/types.h"

namespace toile::research::gpu {

/// A load of all wavelengths [N].
inline std::vector<Vec3> rough_load(int count)
{
    std::vector<Vec3> load(count);
    for (int i = 0; i < count; ++i)
        load[i] = Vec3(std::sin(1.7 * i), std::cos(0.011 * i), std::sin(0.3 * i + 0.5));
    return load;
}

} // namespace toile::research::gpu
