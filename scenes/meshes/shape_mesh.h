#pragma once

#include "collision/geometry/shapes.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::scenes {

/// Triangle surface of a shape for pictures, in the shape's local frame. Edges of a box are sharp: its faces
/// share no vertices.
/// @param plane_side  side of the square that represents a plane [m]
TriangleMesh shape_mesh(const collision::Shape& shape, double plane_side);

} // namespace toile::scenes
