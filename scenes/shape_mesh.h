#pragma once

#include "collision/shapes.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A triangle surface that shows a solid in pictures, in the solid's own frame. Edges of a box are sharp: its
/// faces share no vertices.
/// @param plane_side  side of the square that stands for a plane [m]
TriangleMesh shape_mesh(const Shape& shape, double plane_side);

} // namespace toile
