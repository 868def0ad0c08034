#pragma once

#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Vertices of panels at rest in the axes of their weave: u along the weft, v along the warp.
///
///   m = R(-grain) uv,   R(a) the rotation by a, counter-clockwise
///
/// Panels whose warp is vertical keep their coordinates, bit for bit.
/// @return [vertices] [m]
std::vector<Vec2> material_coordinates(const Pattern& pattern, const PatternMesh& mesh);

} // namespace toile::garment
