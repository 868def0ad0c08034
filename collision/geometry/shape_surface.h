#pragma once

#include "collision/geometry/shapes.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Closed triangle surface of a shape in its own frame, with its vertices on the shape: of a box its sides,
/// of a round shape facets that lie about `sag` [m] below it at most, with 128 segments at most. Empty for a
/// plane.
TriangleMesh shape_surface(const Shape& shape, double sag);

} // namespace toile::collision
