#pragma once

#include <string>
#include <vector>

#include "core/mesh/topology.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Undeformed solid, tetrahedron by tetrahedron.
struct RestTets {
    std::vector<Tet> tets;
    std::vector<Mat3> edges_inv; ///< [tets] inverse of the columns x1 - x0, x2 - x0, x3 - x0 [1/m]
    std::vector<double> volumes; ///< [tets] [m^3]
    Incidence corners_of_vertex; ///< per vertex: 4 * tet + corner, ascending

    int vertex_count() const { return int(corners_of_vertex.first.size()) - 1; }
    int tet_count() const { return int(tets.size()); }

    /// Lumped vertex volumes: a quarter of every adjacent tetrahedron [m^3].
    std::vector<double> vertex_volumes() const;
};

/// Edges x1 - x0, x2 - x0, x3 - x0 of a tetrahedron, in columns [m].
Mat3 edges_of(const Tet& tet, View<const Vec3> x);

/// Gradients of the linear functions that are 1 in one corner of a tetrahedron and 0 in the others, in rows
/// [1/m].
/// @param edges_inv  inverse of edges_of()
Eigen::Matrix<double, 4, 3> hat_gradients(const Mat3& edges_inv);

/// @throws InvalidInput naming `source` and the first tetrahedron whose height is below kMinHeightRatio of
///         its longest edge
void require_no_slivers(const TetMesh& mesh, const std::string& source);

/// @throws InvalidInput as require_no_slivers()
RestTets rest_tets(const TetMesh& mesh, const std::string& source);

} // namespace toile::volume
