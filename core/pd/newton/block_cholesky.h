#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Sparse Cholesky factor A = L L^T of a symmetric positive definite matrix of dense blocks, for matrices of
/// some hundred block rows whose values change often. Rows are eliminated in the order of least degree
/// [George & Liu 1989]. The factor is computed in double precision and applied in single precision.
/// @tparam kSize  rows of a block: 9 or 12
template <int kSize>
class BlockCholesky {
public:
    using Block = Eigen::Matrix<double, kSize, kSize>;
    using Vector = Eigen::Matrix<float, kSize, 1>;

    BlockCholesky() = default;

    /// Orders the rows. O(rows * degree^2).
    /// @param columns  [rows] ascending block columns of each row, both triangles, the diagonal included
    explicit BlockCholesky(const std::vector<std::vector<int>>& columns);

    int rows() const { return int(order_.size()); }

    /// Block of A to be set before factor(): (row, column) of the pattern with slot = place of the column in
    /// its row. Tasks may write different rows in parallel.
    Block& entry(int row, int slot) { return A_[first_entry_[row] + slot]; }

    /// @return false if A is not positive definite
    bool factor();

    /// x = A^-1 x
    /// @param x  [rows]
    void solve(View<Vector> x) const;

private:
    using FloatBlock = Eigen::Matrix<float, kSize, kSize>;
    void find_order(const std::vector<std::vector<int>>& columns);
    void eliminate(int column);

    std::vector<int> first_entry_; ///< [rows + 1] into A_
    std::vector<Block> A_;
    std::vector<int> columns_; ///< [entries of A_]
    std::vector<int> order_;   ///< [rows] row that is eliminated at each place
    std::vector<int> place_;   ///< [rows] inverse of order_

    // Columns of L by place: the diagonal block first, then those below it, ascending.
    std::vector<int> first_below_;             ///< [rows + 1] into below_
    std::vector<int> below_;                   ///< places of rows
    std::vector<Block> L_;                     ///< [below_]
    std::vector<Block> diagonal_;              ///< [rows] lower triangles
    std::vector<FloatBlock> applied_;          ///< [below_] L_ in single precision
    std::vector<FloatBlock> inverse_diagonal_; ///< [rows] inverse of the lower triangle
    mutable std::vector<Vector> y_;            ///< [rows] scratch
};

} // namespace toile
