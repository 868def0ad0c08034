#pragma once

#include "core/mesh/triangle_mesh.h"

namespace toile::research::accuracy {

/// Support of a drape test: a cylinder of radius 9 cm whose upper side is at height 0.
TriangleMesh support_mesh();

} // namespace toile::research::accuracy
