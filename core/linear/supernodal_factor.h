#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Lower triangular factor L in supernodes: runs of columns with the same row pattern, each stored as one
/// dense block with contiguous rows.
//
//      columns [first_column, first_column + width)
//        | L11      |   width x width, lower triangle, diagonal holds 1 / l_jj
//        | L21      |   (rows below) x width; their indices in `rows`
//
/// Solves L L^T x = b for 3-vectors padded to four lanes, so that each entry of L is one fused multiply-add.
class SupernodalFactor {
public:
    struct Supernode {
        int first_column = 0;
        int width = 0;
        int first_row = 0; ///< into rows: the indices below the diagonal block
        int row_count = 0;
        long first_value = 0; ///< into values: (width + row_count) x width, row-major
    };

    std::vector<Supernode> supernodes; ///< ascending columns
    std::vector<int> rows;
    std::vector<double> values;
    std::vector<int> permutation; ///< [n] row k of L is row permutation[k] of the matrix

    /// Splits the elimination tree into subtrees that are solved in parallel and the nodes above them. Call
    /// once after filling the arrays. The split depends on L alone, so a solve has the same bits for every
    /// thread count.
    void plan();

    /// x = P^T L^-T L^-1 P b
    void solve(View<const Vec3> b, View<Vec3> x) const;

private:
    /// Supernodes [first, last) that depend on no others.
    struct Subtree {
        int first = 0, last = 0;
    };

    void split_tree();
    void redirect_rows();

    std::vector<Subtree> subtrees_;
    std::vector<int> top_;          ///< supernodes above the subtrees, ascending
    std::vector<int> top_columns_;  ///< their columns, ascending
    int max_rows_ = 0;              ///< largest row_count
    std::vector<int> forward_rows_; ///< rows; a subtree's updates to the top go to its own slots
};

} // namespace toile
