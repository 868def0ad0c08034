#pragma once

#include "avatars/mannequin/figure.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// The figure's skin as a triangle mesh of about `edge_length` [m]: dual contouring of a regular grid
/// ("surface nets", [Gibson 1998]) with one vertex per connected inside part of a cell, then vertices spread
/// evenly along the surface and put back onto the field.
/// @return closed and manifold; both are checked
/// @throws InvalidInput when the grid is too coarse to tell neighbouring parts apart.
TriangleMesh polygonise(const Figure& figure, double edge_length);

} // namespace toile
