#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// Lower triangular factor L in supernodes: runs of columns that share their row pattern, each stored as one
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

    /// x = P^T L^-T L^-1 P b
    void solve(View<const Vec3> b, View<Vec3> x) const;
};

} // namespace toile
