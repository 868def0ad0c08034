#pragma once

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Shape of the tetrahedra of a mesh.
struct MeshQuality {
    int inverted = 0;               ///< tetrahedra of negative volume, or none
    double smallest_dihedral = 0.0; ///< [degrees] angle between two faces of one
    double mean_edge = 0.0;         ///< [m]
    double volume = 0.0;            ///< [m^3] of all
};
MeshQuality quality_of(const TetMesh& mesh);

/// Angle at the edge from a to b between the planes through c and d [degrees].
double dihedral_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Smallest angle between two faces of a tetrahedron [degrees].
double smallest_dihedral(const Tet& tet, View<const Vec3> x);

} // namespace toile::volume
