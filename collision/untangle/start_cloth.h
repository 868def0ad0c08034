#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// One cloth of a start pose.
struct StartCloth {
    std::vector<Triangle> triangles; ///< [triangles]
    std::vector<Vec3> positions;     ///< [vertices] [m]
    std::vector<char> fixed;         ///< [vertices] nonzero: must stay where it is; empty: none
    int layer = 0;                   ///< higher is further outside
    double gap = 0.001;              ///< [m] to keep from bodies
    double thickness = 0.0005;       ///< [m] of the cloth
};

} // namespace toile
