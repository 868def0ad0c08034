#pragma once

#include <vector>

#include "core/linear/sparse_matrix.h"

namespace toile::research {

/// Damping of a Jacobi step that smooths coarse functions, over the highest eigenvalue of D^-1 A [-]
/// [Vanek, Mandel, Brezina 1996].
inline constexpr double kProlongationDamping = 4.0 / 3.0;

/// functions - damping D^-1 A functions, D = diag(A): one Jacobi step towards A functions = 0 for every
/// column. Functions are unchanged where A has no row.
/// @param functions  [n x count]
SparseMatrix jacobi_smoothed(const SparseMatrix& A, const SparseMatrix& functions, double damping);

/// Smooth bumps around farthest-point samples of the graph of A, which add up to 1 at every vertex they
/// reach:
///
///   P_is = w(d_is) / sum_t w(d_it),    w(d) = (1 - d / reach)^2 for d < reach, else 0
///
/// d_is [edges] counts the edges from sample s to vertex i. `reach` is `overlap` times the largest distance
/// of a vertex from its closest sample, plus one. If `count` allows, every connected part has a sample.
/// @param inverse_diagonal  [n] 0 for rows to leave out; vertices without neighbours stay out too
/// @param count             max number of samples
/// @return                  [n x samples]
SparseMatrix partition_of_unity(const SparseMatrix& A, View<const double> inverse_diagonal, int count,
                                double overlap);

} // namespace toile::research
