#pragma once

#include "core/mesh/triangle_mesh.h"

namespace toile::research::stress {

enum class Sliver {
    Needle, ///< one edge far shorter than the other two
    Cap,    ///< one corner nearly on the opposite edge
};

/// A square sheet in the plane y = 0, centred, with a sliver in every cell.
/// @param side    [m]
/// @param cells   along each side
/// @param aspect  longest edge of a sliver over its height [-]
TriangleMesh sliver_sheet(Sliver kind, double side, int cells, double aspect);

} // namespace toile::research::stress
