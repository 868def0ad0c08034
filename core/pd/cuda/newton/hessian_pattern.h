#pragma once

#include <vector>

#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// Places of the entries of a matrix row by row, in slices of a warp's rows: thread k of a warp takes row k,
/// and the warp's loads are contiguous. All rows of a slice have the length of its longest row.
class SlicedPattern {
public:
    /// @param columns  [rows] of each row, ascending
    explicit SlicedPattern(const std::vector<std::vector<int>>& columns);

    int size() const { return int(columns_.size()); }            ///< entries, padding included
    const std::vector<int>& first() const { return first_; }     ///< [slices + 1]
    const std::vector<int>& columns() const { return columns_; } ///< [size()] the row itself where padded

    /// @return -1 if the row has no such column
    int position(int row, int column) const;

private:
    std::vector<int> first_, columns_;
    std::vector<int> length_; ///< [rows]
};

/// Pattern of a Hessian K without its diagonal, and the places of its entries:
///
///   (K p)_i = S_i p_i + sum_j (K_ij + s_ij I) (p_j - p_i)
///
/// K_ij are 3 x 3 blocks, s_ij numbers that are equal for x, y and z. In this form a rigid translation costs
/// S_i alone, without the rounding error of stiff blocks.
class HessianPattern {
public:
    /// @param blocks     [vertices x vertices]
    /// @param isotropic  [vertices x vertices] its values are the constant part of s [N/m]
    HessianPattern(const BlockMatrix& blocks, const SparseMatrix& isotropic);

    const SlicedPattern& blocks() const { return blocks_; }
    const SlicedPattern& scalars() const { return scalars_; }
    const std::vector<float>& constant_scalars() const { return constant_; } ///< by position [N/m]

    /// Positions of the entries between two different vertices; -1 if there is none.
    int block_position(int i, int j) const { return blocks_.position(i, j); }
    int scalar_position(int i, int j) const { return scalars_.position(i, j); }

private:
    SlicedPattern blocks_, scalars_;
    std::vector<float> constant_;
};

} // namespace toile
