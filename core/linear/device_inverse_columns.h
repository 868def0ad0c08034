#pragma once

#include "core/backend/cuda/array.h"
#include "core/linear/forward_plan.h"
#include "core/linear/inverse_kernels.h"

namespace toile {

/// InverseColumns on a GPU: hundreds of columns of A^-1 at once, in double precision. A level of the
/// elimination tree is two launches forward and one back. Sums are in another order than the CPU's, and have
/// the same bits in every run.
class DeviceInverseColumns {
public:
    /// Columns come in as many as this.
    static constexpr int kColumnMultiple = ProductTile::kColumns;

    /// Uploads the factor.
    /// @param space, factor  borrowed
    /// @throws DeviceError where the device has not the memory
    DeviceInverseColumns(const CudaSpace& space, const InvertedFactor& factor);

    /// Makes room for blocks of up to `columns` columns, a multiple of kColumnMultiple.
    /// @param front_rows  most rows of a block's fronts (plan_forward)
    void reserve(int columns, int front_rows);

    /// Enqueues columns of A^-1.
    /// @param targets  indices of the columns, -1 for a column of zeros; at most as many as reserved
    void solve(View<const int> targets);

    /// [n][columns] of the last solve: row k belongs to row factor.permutation()[k] of A. Columns beyond the
    /// targets are undefined.
    ColumnBlock rows() { return {x_.view().data(), stride_}; }

    /// Where row `i` of A stands in them.
    int row_of(int i) const { return row_of_[i]; }

    /// What it takes of the device's memory [bytes]: once, and for every column.
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
