#pragma once

#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Whether a panel is smaller or larger at rest than it is cut.
bool shrinks(const Panel& panel);

/// Vertices of panels at rest in the axes of their weave: u along the weft, v along the warp.
///
///   m = diag(shrink_weft, shrink_warp) R(-grain) uv,   R(a) the rotation by a, counter-clockwise
///
/// Panels whose warp is vertical and that do not shrink keep their coordinates, bit for bit.
/// @return [vertices] [m]
std::vector<Vec2> material_coordinates(const Pattern& pattern, const PatternMesh& mesh);

} // namespace toile::garment
