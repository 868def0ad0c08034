#pragma once

#include "avatars/mannequin/mannequin_shape.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::avatars {

/// Skin of the mannequin as a triangle mesh with edges of about `edge_length` [m]. Dual contouring of a
/// regular grid ("surface nets", [Gibson 1998]) has one vertex per connected inside part of a cell. Then
/// vertices are distributed evenly along the surface and projected back onto the field.
/// @return closed and manifold; both are checked
/// @throws InvalidInput if the grid is too coarse to separate neighbouring parts.
TriangleMesh polygonise(const MannequinShape& shape, double edge_length);

} // namespace toile::avatars
