#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// One cloth, or surface of a soft body, of a start pose.
struct StartCloth {
    std::vector<Triangle> triangles; ///< [triangles]
    std::vector<Vec3> positions;     ///< [vertices] [m]
    std::vector<char> fixed;         ///< [vertices] nonzero: must not move; empty: none
    int layer = 0;                   ///< higher is farther outside
    double gap = 0.001;              ///< [m] minimum distance from bodies
    double thickness = 0.0005;       ///< [m] of the cloth
};

} // namespace toile::collision
