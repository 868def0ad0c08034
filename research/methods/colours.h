#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"
#include "garment/energy/bending.h"

namespace toile::research {

/// An off-diagonal entry of the bending matrix.
struct Coupling {
    int vertex;
    double stiffness; ///< [N/m]
};

/// Entries of K in each row, without entries that are rounding of sums that cancel.
/// @param K  Bending::matrix()
std::vector<std::vector<Coupling>> couplings(const SparseMatrix& K);

/// Colours vertices so that no two of one colour share a triangle or an entry of K, for vertex block descent
/// on CPU and GPU.
std::vector<std::vector<int>> colour_vertices(const garment::RestShape& rest, const SparseMatrix& K);

/// Colours curvature stencils so that no two of one colour share a vertex.
std::vector<std::vector<int>> colour_stencils(const std::vector<garment::Bending::Term>& terms,
                                              int vertex_count);

} // namespace toile::research
