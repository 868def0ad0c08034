#pragma once

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Collapses edges shorter than `length` [m], shortest first: one end moves to the other, that which is
/// more free to the surface or the edge of it. An edge is left as it is where this would change the mesh's
/// topology (link condition [Dey et al. 1999]), turn a tetrahedron inside out, leave a dihedral angle that is
/// smaller than before and than 8 degrees, change the body's volume by more than length^3, or let its surface
/// cross itself. In the order of the edges: the same bytes for the same mesh.
/// @param mesh  oriented
void collapse_short_edges(TetMesh& mesh, double length);

} // namespace toile::volume
