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

/// @throws InvalidInput naming `source` and the first tetrahedron whose height is below kMinHeightRatio of
///         its longest edge
void require_no_slivers(const TetMesh& mesh, const std::string& source);

/// @throws InvalidInput as require_no_slivers()
RestTets rest_tets(const TetMesh& mesh, const std::string& source);

} // namespace toile::volume
