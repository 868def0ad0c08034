#pragma once

#include <utility>
#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Symmetric sparse matrix of 3 x 3 blocks, [3n x 3n], with a fixed pattern and changing values. Both
/// triangles are stored, rows contiguous, columns ascending; every diagonal block exists.
class BlockMatrix {
public:
    BlockMatrix() = default;

    /// Sets all blocks to zero.
    /// @param couplings  pairs (i, j) of block rows that share entries, in any order, repeats allowed
    BlockMatrix(int rows, const std::vector<std::pair<int, int>>& couplings);

    int rows() const { return int(diagonal_.size()); }
    void set_zero();

    /// Block (row, column), which must be in the pattern. O(log of the row's length). Tasks that write
    /// different rows may run in parallel.
    Mat3& block(int row, int column) { return values(row)[position(row, column)]; }

    /// Position of block (row, column) in its row. O(log of the row's length).
    int position(int row, int column) const;
    Mat3* values(int row) { return blocks_.data() + first_[row]; } ///< blocks of a row

    const Mat3& diagonal(int row) const { return blocks_[diagonal_[row]]; }

    /// Product of row `row` with x [n].
    Vec3 row_times(int row, View<const Vec3> x) const
    {
        Vec3 sum = Vec3::Zero();
        for (int k = first_[row]; k < first_[row + 1]; ++k)
            sum.noalias() += blocks_[k] * x[columns_[k]];
        return sum;
    }

    /// Columns and blocks of a row.
    View<const int> columns(int row) const
    {
        return {columns_.data() + first_[row], first_[row + 1] - first_[row]};
    }
    View<const Mat3> blocks(int row) const
    {
        return {blocks_.data() + first_[row], first_[row + 1] - first_[row]};
    }

private:
    std::vector<int> first_;    ///< [rows + 1] into columns_ and blocks_
    std::vector<int> columns_;  ///< ascending in each row
    std::vector<int> diagonal_; ///< [rows] into blocks_
    std::vector<Mat3> blocks_;
};

/// Rows and columns of a BlockMatrix from `first` on, numbered from 0: the part that one of several cloths
/// writes.
class BlockWindow {
public:
    BlockWindow(BlockMatrix& matrix, int first = 0) : matrix_(&matrix), first_(first) {}

    /// Block of the matrix, see BlockMatrix::block.
    Mat3& block(int row, int column) const { return matrix_->block(first_ + row, first_ + column); }

    /// See BlockMatrix; for repeated writes.
    int position(int row, int column) const { return matrix_->position(first_ + row, first_ + column); }
    Mat3* values(int row) const { return matrix_->values(first_ + row); }

    BlockWindow from(int row) const { return {*matrix_, first_ + row}; }

private:
    BlockMatrix* matrix_;
    int first_;
};

} // namespace toile
