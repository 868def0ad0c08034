#pragma once

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Improves the flattest tetrahedra of a mesh, those with a dihedral angle below kSliver: moves vertices
/// to where the smallest angle around them is largest, a pattern search after
/// [Freitag & Ollivier-Gooch 1997], and peels off flat ones that lie on the surface with two faces, which
/// changes the diagonal of a surface that is nearly plane there. Vertices of a smooth surface move in its
/// tangent plane, those of edges and corners stay. In the order of the vertices: the same bytes for the same
/// mesh.
/// @param mesh  oriented
void improve_slivers(TetMesh& mesh);

/// Dihedral angle below which a tetrahedron counts as a sliver [degrees].
inline constexpr double kSliver = 15.0;

} // namespace toile::volume
