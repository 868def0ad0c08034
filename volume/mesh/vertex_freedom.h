#pragma once

#include <vector>

#include "core/mesh/topology.h"

namespace toile::volume {

/// Where a vertex can go without changing the shape of its body: nowhere, on the tangent plane of a smooth
/// surface, or everywhere.
enum class Freedom : unsigned char { None, Plane, Space };

struct VertexFreedom {
    std::vector<Freedom> of;  ///< [vertices]
    std::vector<Vec3> normal; ///< [vertices] of the surface, outwards, any length; 0 inside
};

/// Vertices of edges at which the surface bends by more than about 45 degrees, and of points, are held.
/// @param x        [vertices] [m] of a body
/// @param surface  triangles of its surface, counter-clockwise seen from outside
VertexFreedom vertex_freedom(View<const Vec3> x, View<const Triangle> surface);

} // namespace toile::volume
