#pragma once

#include <vector>

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Extends values u from some vertices to the others so that the integral of |grad u|^2 over the mesh is
/// smallest, with linear finite elements: u is harmonic between the given values. Conjugate gradients, to a
/// relative residual of 1e-6.
/// @param is_given  [vertices] nonzero: the value stays; at least one of every connected part
/// @param values    [vertices x 3] changed where not given
void extend_harmonically(const TetMesh& mesh, View<const char> is_given, View<Vec3> values);

} // namespace toile::volume
