#pragma once

#include <array>
#include <vector>

#include "core/compute/lanes.h"
#include "core/linear/supernodal_factor.h"

namespace toile {

/// Columns of A^-1 from a factor A = P^T L L^T P, a block at a time: rows of the kernel that quadrature
/// tabulates. One pass over L serves all columns of a block, so that the work is in products of small dense
/// matrices. Forward substitution visits only the supernodes between the block's columns and the root.
class InverseColumns {
public:
    static constexpr int kColumns = 32; ///< columns of a block

    /// Row of a block: an entry of each column.
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

    /// [n] rows; row k belongs to row factor.permutation[k] of A.
    using Block = std::vector<Row>;

    /// @param factor  borrowed
    explicit InverseColumns(const SupernodalFactor& factor);

    int size() const { return int(row_of_.size()); }

    /// Row of a block that belongs to row `i` of A.
    int row_of(int i) const { return row_of_[i]; }

    /// Solves for columns `columns` of A^-1, one per lane of `block`; lanes beyond them are zero. Safe to
    /// call from several threads, with a block each.
    /// @param columns  at most kColumns
    void solve(View<const int> columns, Block& block) const;

private:
    void forward(View<const int> columns, Block& block) const;
    void backward(Block& block) const;

    const SupernodalFactor& factor_;
    std::vector<int> row_of_;         ///< [n] inverse permutation
    std::vector<int> node_of_column_; ///< [n] supernode
};

/// Forward substitution with one supernode: y_node = L11^-1 y_node, y_below -= L21 y_node.
/// @param rows  [row_count] indices in y of the rows below the diagonal block
/// @param L     the supernode's block
/// @param y     the supernode's rows begin at first_column
void forward_node(const SupernodalFactor::Supernode& node, const int* rows, const double* L,
                  InverseColumns::Row* y);

} // namespace toile
