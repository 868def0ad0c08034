#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/SparseCore>

#include "core/compute/hash.h"
#include "core/compute/types.h"

namespace toile {

/// Symmetric matrix shared by x, y and z: both triangles stored, rows contiguous.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Entries (row, column, value) that are summed into a SparseMatrix in the order they were added.
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Hash of the pattern and the bits of the values.
/// @param A  compressed
Hash128 hash_of(const SparseMatrix& A);

/// Rows and columns of a sparse matrix from `first` on, numbered from 0: the part that one of several cloths
/// writes. The pattern stays.
class SparseWindow {
public:
    SparseWindow(SparseMatrix& matrix, int first = 0) : matrix_(&matrix), first_(first) {}

    /// Position of an entry of the pattern in its row. O(log of the row's length).
    int position(int row, int column) const
    {
        const int* const begin = matrix_->innerIndexPtr() + matrix_->outerIndexPtr()[first_ + row];
        const int* const end = matrix_->innerIndexPtr() + matrix_->outerIndexPtr()[first_ + row + 1];
        const int* const found = std::lower_bound(begin, end, first_ + column);
        TOILE_ASSERT(found != end && *found == first_ + column);
        return int(found - begin);
    }

    /// Values of a row in the order of its columns.
    double* values(int row) const { return matrix_->valuePtr() + matrix_->outerIndexPtr()[first_ + row]; }

    SparseWindow from(int row) const { return {*matrix_, first_ + row}; }

private:
    SparseMatrix* matrix_;
    int first_;
};

/// Product of one row of A with a field of vectors.
template <typename Vec>
Vec row_times(const SparseMatrix& A, int row, View<const Vec> x)
{
    Vec sum = Vec::Zero();
    for (int k = A.outerIndexPtr()[row]; k < A.outerIndexPtr()[row + 1]; ++k)
        sum += A.valuePtr()[k] * x[A.innerIndexPtr()[k]];
    return sum;
}
inline Vec3 row_times(const SparseMatrix& A, int row, View<const Vec3> x)
{
    return row_times<Vec3>(A, row, x);
}

/// Numbers of `count` rows that follow each other.
std::vector<int> consecutive_rows(int first, int count);

/// These rows and columns of H, numbered from 0.
/// @param rows  ascending
/// @throws InvalidInput if an entry of these rows lies outside the block
SparseMatrix diagonal_block(const SparseMatrix& H, View<const int> rows);

} // namespace toile
