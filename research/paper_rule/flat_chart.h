#pragma once

#include <optional>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::research {

/// Coordinates of a flat mesh in its plane: distances are kept, triangles run counter-clockwise.
/// @return [vertices] [m]; nothing for a mesh that is not flat or folded over itself at an edge
std::optional<std::vector<Vec2>> flat_chart(const TriangleMesh& mesh);

} // namespace toile::research
