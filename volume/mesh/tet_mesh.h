#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/mesh/topology.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::volume {

/// Corners of a tetrahedron, positively oriented: (b - a) x (c - a) . (d - a) > 0.
using Tet = std::array<int, 4>;

/// Mesh of linear tetrahedra.
struct TetMesh {
    std::vector<Vec3> positions; ///< [vertices] [m]
    std::vector<Tet> tets;       ///< [tets]
    int turned = 0;              ///< of these, tetrahedra that orient() has turned

    int vertex_count() const { return int(positions.size()); }
    int tet_count() const { return int(tets.size()); }
};

/// Signed volume of a tetrahedron, negative inside out.
double volume_of(const Tet& tet, View<const Vec3> x);

/// Swaps two corners of tetrahedra with negative volume.
/// @param name_of  names a tetrahedron in errors, e.g. "cell 7"
/// @throws InvalidInput naming `source` and the first that is flat, or two that lie on the same side of a
///         face
void orient(TetMesh& mesh, const std::function<std::string(int tet)>& name_of, const std::string& source);

/// Removes vertices that no tetrahedron uses; the others keep their order.
void remove_unused_vertices(TetMesh& mesh);

/// Triangles that belong to only one tetrahedron, counter-clockwise seen from outside.
std::vector<Triangle> boundary_triangles(View<const Tet> tets);

/// The same as a mesh of their vertices only, in the order of the tetrahedral mesh.
TriangleMesh boundary_surface(const TetMesh& mesh);

} // namespace toile::volume
