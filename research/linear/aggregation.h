#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"

namespace toile::research {

/// Groups of vertices that become one unknown each on the next coarser level.
struct Aggregation {
    std::vector<int> group; ///< [n] group of each vertex; -1 if left to the smoother
    int count = 0;
};

/// Strong entries of A, |a_ij| > strength sqrt(a_ii a_jj), and the diagonal, to which weak ones are added:
/// rows keep their sum [Vanek, Mandel, Brezina 1996]. Rows left out are empty.
/// @param inverse_diagonal  [n] 1 / a_ii, or 0 for rows to leave out
SparseMatrix strong_part(const SparseMatrix& A, View<const double> inverse_diagonal, double strength);

/// Groups vertices greedily [Vanek, Mandel, Brezina 1996]. First come whole neighbourhoods. Left-over
/// vertices then join the neighbouring group to which they are coupled most. The rest forms neighbourhoods
/// again. Rows without neighbours stay out.
/// @param strong  see strong_part()
Aggregation aggregate(const SparseMatrix& strong);

/// Characteristic functions of the groups [n x count].
SparseMatrix characteristic_functions(const Aggregation& groups);

} // namespace toile::research
