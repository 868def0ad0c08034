#pragma once

#include <vector>

#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// Positions [m] as points of a ClusterTree: the other axes are zero.
inline std::vector<EmbeddedPoint> embedded(View<const Vec3> x)
{
    std::vector<EmbeddedPoint> points(x.size(), EmbeddedPoint::Zero());
    for (int i = 0; i < x.size(); ++i)
        points[i].head<3>() = x[i];
    return points;
}

} // namespace toile
