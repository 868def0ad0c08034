#pragma once

#include "core/compute/cuda/array.h"
#include "core/linear/forward_plan.h"
#include "core/linear/inverse_kernels.h"

namespace toile {

/// InverseColumns on a GPU: hundreds of columns of A^-1 at once, in double precision. A level of the
/// elimination tree takes two launches forward and one back. Sums have another order than the CPU's, and the
/// same bits in every run.
class DeviceInverseColumns {
public:
    /// Divisor of the number of columns in a block.
    static constexpr int kColumnMultiple = ProductTile::kColumns;

    /// Uploads the factor.
    /// @param space, factor  borrowed
    /// @throws DeviceError if the device has not the memory
    DeviceInverseColumns(const CudaSpace& space, const InvertedFactor& factor);

    /// Allocates blocks of up to `columns` columns, a multiple of kColumnMultiple.
    /// @param front_rows  max number of rows of a block's fronts (plan_forward)
    void reserve(int columns, int front_rows);

    /// Enqueues a solve for columns of A^-1.
    /// @param targets  indices of the columns, -1 for a column of zeros; at most as many as reserved
    void solve(View<const int> targets);

    /// Result of the last solve, [n][columns]: row k belongs to row factor.permutation()[k] of A. Columns
    /// beyond the targets are undefined.
    ColumnBlock rows() { return {x_.view().data(), stride_}; }

    /// Row of the result that belongs to row `i` of A.
    int row_of(int i) const { return row_of_[i]; }

    /// Device memory that it takes [bytes]: once, and for every column.
    static std::size_t fixed_bytes(const InvertedFactor& factor);
    static std::size_t column_bytes(const InvertedFactor& factor, int front_rows);

private:
    void upload_plan(View<const int> targets);
    void eliminate(int level, int columns);
    void substitute_back(int level, int columns);

    const CudaSpace& space_;
    const InvertedFactor& factor_;
    std::vector<int> row_of_; ///< [n] inverse permutation
    std::vector<int> unit_row_host_;
    LevelTiles column_tiles_;
    ForwardPlan plan_;
    InvertedFactorView view_;
    int stride_ = 0;
    DeviceArray<InvertedNode> nodes_;
    DeviceArray<int> rows_, first_child_, children_, front_of_, unit_row_;
    DeviceArray<RowTile> tiles_, front_tiles_;
    DeviceArray<double> values_, x_, fronts_, solved_;
};

} // namespace toile
