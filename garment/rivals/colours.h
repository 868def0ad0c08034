#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"
#include "garment/energy/bending.h"

namespace toile {

/// An entry of the bending matrix beside the diagonal.
struct Coupling {
    int vertex;
    double stiffness; ///< [N/m]
};

/// Entries of K in each row, without those that are rounding left over from sums that cancel.
/// @param K  of Bending::matrix()
std::vector<std::vector<Coupling>> couplings(const SparseMatrix& K);

/// Colours vertices so that no two of one colour share a triangle or an entry of K: those of vertex block
/// descent, on any machine.
std::vector<std::vector<int>> colour_vertices(const RestShape& rest, const SparseMatrix& K);

/// Colours curvature stencils so that no two of one colour share a vertex.
std::vector<std::vector<int>> colour_stencils(const std::vector<Bending::Term>& terms, int vertex_count);

} // namespace toile
