#pragma once

#include <algorithm>
#include <cmath>

#include "core/mesh/triangle_mesh.h"

namespace toile::research::paper {

/// Voxels of half a mean edge along the longest side of a body, for the paper's rule.
inline int half_edges_along(View<const Vec3> rest, View<const Triangle> triangles)
{
    double mean_edge = 0.0;
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            mean_edge += (rest[t[k]] - rest[t[(k + 1) % 3]]).norm() / (3.0 * triangles.size());
    const Bounds box = bounds(rest);
    return std::max(1, int(std::lround(2.0 * (box.upper - box.lower).maxCoeff() / mean_edge)));
}

} // namespace toile::research::paper
