#pragma once

#include <algorithm>

#include "core/linear/sparse_matrix.h"

namespace toile {

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
        return int(std::lower_bound(begin, end, first_ + column) - begin);
    }

    /// Values of a row in the order of its columns.
    double* values(int row) const { return matrix_->valuePtr() + matrix_->outerIndexPtr()[first_ + row]; }

    SparseWindow from(int row) const { return {*matrix_, first_ + row}; }

private:
    SparseMatrix* matrix_;
    int first_;
};

} // namespace toile
