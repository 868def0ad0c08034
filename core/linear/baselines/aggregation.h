#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"

namespace toile {

/// Groups of vertices that become one unknown each on the next coarser level.
struct Aggregation {
    std::vector<int> group; ///< [n] of each vertex; -1 for one that is left to the smoother
    int count = 0;
};

/// The entries of A that are strong, |a_ij| > strength sqrt(a_ii a_jj), and the diagonal, to which weak ones
/// are added: rows keep their sum [Vanek, Mandel, Brezina 1996]. Rows left out are empty.
/// @param inverse_diagonal  [n] 1 / a_ii, or 0 for rows to leave out
SparseMatrix strong_part(const SparseMatrix& A, View<const double> inverse_diagonal, double strength);

/// Greedy grouping [Vanek, Mandel, Brezina 1996]: whole neighbourhoods first, then left-over
/// vertices to the neighbouring group they are coupled to most, then what remains by neighbourhoods again.
/// Rows without neighbours stay out.
/// @param strong  see strong_part()
Aggregation aggregate(const SparseMatrix& strong);

/// The groups' characteristic functions [n x count].
SparseMatrix characteristic_functions(const Aggregation& groups);

} // namespace toile
