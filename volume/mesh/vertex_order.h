#pragma once

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Vertices in an order that suits products with sparse matrices: those that are near each other follow each
/// other, 64 by 64 as preconditioners group them (ConnectedClusters), and each 64 by their number of
/// neighbours, so that rows which a GPU pads to one length are about as long.
std::vector<int> vertex_order(const TetMesh& mesh);

/// Sorts tetrahedra by their smallest vertex: those that follow each other share vertices.
void sort_by_vertex(std::vector<Tet>& tets);

} // namespace toile::volume
