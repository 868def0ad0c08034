#pragma once

#include <vector>

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Extends values from some vertices to the others so that the integral of the squared gradient over the mesh
/// is smallest (linear finite elements).
/// @param is_given  [vertices] nonzero: the value stays; at least one of every connected part
/// @param values    [vertices] changed where not given
void extend_harmonically(const TetMesh& mesh, View<const char> is_given, View<Vec3> values);

} // namespace toile::volume
