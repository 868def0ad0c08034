#pragma once

#include <array>
#include <vector>

#include "core/backend/lanes.h"
#include "core/linear/supernodal_factor.h"

namespace toile {

/// Columns of A^-1 from a factor A = P^T L L^T P, a block at a time: rows of the kernel that quadrature
/// tabulates. One pass over L serves all columns of a block, so that the work is in products of small dense
/// matrices; forward substitution visits only the supernodes between the block's columns and the root.
class InverseColumns {
public:
    static constexpr int kColumns = 32; ///< of a block

    /// One row of a block: an entry of each column.
    struct Row {
        std::array<Lanes, kColumns / kLanes> lanes{};

        double operator[](int column) const { return lanes[column / kLanes][column % kLanes]; }
        Row& operator+=(const Row& other)
        {
            for (size_t k = 0; k < lanes.size(); ++k)
                lanes[k] += other.lanes[k];
            return *this;
        }
        Row& operator-=(const Row& other)
        {
            for (size_t k = 0; k < lanes.size(); ++k)
                lanes[k] -= other.lanes[k];
            return *this;
        }
        friend Row squared(Row row)
        {
            for (Lanes& lane : row.lanes)
                lane *= lane;
            return row;
        }
        friend Row operator*(double factor, Row row)
        {
            for (Lanes& lane : row.lanes)
                lane *= factor;
            return row;
        }
    };

    /// [n] row k belongs to row factor.permutation[k] of A.
    using Block = std::vector<Row>;

    /// @param factor  borrowed
    explicit InverseColumns(const SupernodalFactor& factor);

    int size() const { return int(row_of_.size()); }

    /// Where row `i` of A stands in a block.
    int row_of(int i) const { return row_of_[i]; }

    /// Columns `columns` of A^-1 into `block`, one per lane; lanes beyond them are zero. Safe to call from
    /// several threads, with a block each.
    /// @param columns  at most kColumns
    void solve(View<const int> columns, Block& block) const;

private:
    void forward(View<const int> columns, Block& block) const;
    void backward(Block& block) const;

    const SupernodalFactor& factor_;
    std::vector<int> row_of_;         ///< [n] inverse permutation
    std::vector<int> node_of_column_; ///< [n] supernode
};

/// Forward substitution with one supernode: y_own = L11^-1 y_own, y_below -= L21 y_own.
/// @param rows  [row_count] where the rows below the diagonal block stand in y
/// @param L     the supernode's block
/// @param y     its own rows from first_column on
void forward_node(const SupernodalFactor::Supernode& node, const int* rows, const double* L,
                  InverseColumns::Row* y);

} // namespace toile
