#pragma once

#include <cstddef>

#include "core/backend/cuda/async_copy.h"
#include "core/linear/forward_plan.h"

/// Columns of A^-1 from an InvertedFactor on a GPU: what DeviceInverseColumns launches, level by level.
namespace toile {

/// Rows of equally many numbers, one for every column of the inverse that is solved for.
struct ColumnBlock {
    double* data = nullptr;
    int stride = 0;

    TOILE_HD double* row(int i) const { return data + std::size_t(i) * stride; }
};

/// Fronts before their node is eliminated: the unit vectors, and what the node's children pass on, in their
/// order.
///
/// Item i is a column of a row of a tile.
struct AssembleFronts {
    InvertedFactorView factor;
    View<const RowTile> tiles; ///< of one level
    View<const int> front_of;  ///< [nodes]
    View<const int> unit_row;  ///< [columns] row of a column's 1, -1 where there is none
    ColumnBlock fronts;

    TOILE_HD void operator()(int i) const
    {
        const int column = i % unit_row.size();
        const RowTile tile = tiles[i / unit_row.size() / RowTile::kRows];
        const InvertedNode& node = factor.nodes[tile.node];
        const int local = tile.first_row + i / unit_row.size() % RowTile::kRows;
        if (local >= node.height())
            return;
        const bool is_own = local < node.width;
        const int row = is_own ? node.first_column + local : factor.rows[node.first_row + local - node.width];
        double sum = is_own && unit_row[column] == row ? 1.0 : 0.0;
        for (int c = factor.first_child[tile.node]; c < factor.first_child[tile.node + 1]; ++c)
            if (const int child = factor.children[c]; front_of[child] >= 0)
                sum += passed_on(child, row, column);
        fronts.row(front_of[tile.node] + local)[column] = sum;
    }

private:
    /// What a child's front holds of a row of the matrix.
    TOILE_HD double passed_on(int child, int row, int column) const
    {
        const InvertedNode& node = factor.nodes[child];
        const int* const rows = factor.rows.data() + node.first_row;
        int first = 0, last = node.row_count;
        while (first < last) {
            const int middle = (first + last) / 2;
            if (rows[middle] < row)
                first = middle + 1;
            else
                last = middle;
        }
        if (first == node.row_count || rows[first] != row)
            return 0.0;
        return fronts.row(front_of[child] + node.width + first)[column];
    }
};

/// A tile of a product of a node's block with rows of columns: kRows x kColumns numbers, a thread has
/// kOwnRows x kOwnColumns of them.
struct ProductTile {
    static constexpr int kRows = RowTile::kRows;
    static constexpr int kColumns = 128;
    static constexpr int kDepth = 8; ///< summands of a step
    static constexpr int kThreads = 128;
    static constexpr int kOwnRows = 8, kOwnColumns = 4;
    static_assert(kThreads * kOwnRows * kOwnColumns == kRows * kColumns);
    static_assert(kThreads == kDepth * kRows / 2); // SubstituteBack fetches a pair of the block a thread

    /// Two numbers: one load of 16 bytes.
    struct alignas(16) Pair {
        double value[2];
    };
    struct Stage {
        Pair block[kDepth][kRows / 2];
        Pair columns[kDepth][kColumns / 2];
    };
    struct Sums {
        double of[kOwnRows][kOwnColumns];
    };

    // Threads of a tile: a warp has 16 x 64 of its numbers. A thread's columns are two pairs, so that 16
    // threads side by side read 256 bytes in a row.
    TOILE_HD static int first_row(int thread) { return (thread / 64 * 2 + thread / 16 % 2) * kOwnRows; }
    TOILE_HD static int pair(int thread, int k) { return thread / 32 % 2 * 32 + k * 16 + thread % 16; }

    /// Fetches the rows of a step into the stage, a warp one row at a time.
    /// @param row_of  row_of(k) of the step's k-th summand
    template <typename RowOf>
    TOILE_HD static void load_columns(int thread, const RowOf& row_of, Stage& stage)
    {
        for (int k = thread / 64; k < kDepth; k += kThreads / 64)
            copy_async(&stage.columns[k][thread % 64], reinterpret_cast<const Pair*>(row_of(k)) + thread % 64,
                       false);
    }

    TOILE_HD static void add(int thread, const Stage& stage, Sums& sums)
    {
        for (int k = 0; k < kDepth; ++k) {
            double a[kOwnRows], b[kOwnColumns];
            for (int i = 0; i < kOwnRows / 2; ++i) {
                const Pair two = stage.block[k][first_row(thread) / 2 + i];
                a[2 * i] = two.value[0];
                a[2 * i + 1] = two.value[1];
            }
            for (int j = 0; j < kOwnColumns / 2; ++j) {
                const Pair two = stage.columns[k][pair(thread, j)];
                b[2 * j] = two.value[0];
                b[2 * j + 1] = two.value[1];
            }
            for (int i = 0; i < kOwnRows; ++i)
                for (int j = 0; j < kOwnColumns; ++j)
                    sums.of[i][j] += a[i] * b[j];
        }
    }
};

/// The part of a thread in tile `item` of a level's products: tiles of rows, each with all tiles of columns.
template <typename Kernel>
TOILE_HD typename Kernel::Work tile_of_level(const Kernel& kernel, int item, int thread)
{
    const RowTile tile = kernel.tiles[item / kernel.column_tiles];
    return {kernel,
            kernel.factor.nodes[tile.node],
            tile.first_row,
            item % kernel.column_tiles * Kernel::kColumns,
            kernel.front_of[tile.node],
            thread};
}

/// Forward substitution with one level's nodes: y_own = L11^-1 c_own goes to `solved`, and to the rows below
/// of the fronts is added -L21 y_own = (-L21 L11^-1) c_own.
struct EliminateNodes : ProductTile {
    InvertedFactorView factor;
    View<const RowTile> tiles; ///< of one level's fronts
    View<const int> front_of;  ///< [nodes]
    ColumnBlock fronts, solved;
    int column_tiles = 0;

    struct Work {
        const EliminateNodes& kernel;
        InvertedNode node;
        int first_row, first_column, front, thread;

        /// The block's rows of L11^-1 end at the diagonal.
        TOILE_HD int summands() const
        {
            return first_row + kRows < node.width ? first_row + kRows : node.width;
        }
        TOILE_HD int steps() const { return (summands() + kDepth - 1) / kDepth; }
        TOILE_HD void load(int step, Stage& stage) const
        {
            for (int e = thread; e < kDepth * kRows; e += kThreads) {
                const int k = step * kDepth + e % kDepth, i = e / kDepth;
                const bool is_outside = k >= node.width || first_row + i >= node.height();
                const std::size_t at =
                    is_outside ? 0 : node.first_value + std::size_t(first_row + i) * node.stride + k;
                copy_async(&stage.block[e % kDepth][i / 2].value[i % 2], kernel.factor.values.data() + at,
                           is_outside);
            }
            load_columns(
                thread,
                [&](int k) {
                    const int own = step * kDepth + k;
                    return kernel.fronts.row(front + (own < node.width ? own : 0)) + first_column;
                },
                stage);
        }
        TOILE_HD void add(const Stage& stage, Sums& sums) const { ProductTile::add(thread, stage, sums); }
        TOILE_HD void store(const Sums& sums) const
        {
            for (int i = 0; i < kOwnRows; ++i) {
                const int local = first_row + ProductTile::first_row(thread) + i;
                if (local >= node.height())
                    return;
                const bool is_own = local < node.width;
                double* const row =
                    (is_own ? kernel.solved : kernel.fronts).row(front + local) + first_column;
                for (int j = 0; j < kOwnColumns; ++j) {
                    double& number = row[2 * pair(thread, j / 2) + j % 2];
                    number = is_own ? sums.of[i][j] : number + sums.of[i][j];
                }
            }
        }
    };

    TOILE_HD Work work(int item, int thread) const { return tile_of_level(*this, item, thread); }
};

/// Back substitution with one level's nodes: x_own = L11^-T y_own + (-L21 L11^-1)^T x_below.
struct SubstituteBack : ProductTile {
    InvertedFactorView factor;
    View<const RowTile> tiles; ///< of one level's columns
    View<const int> front_of;  ///< [nodes]
    ColumnBlock solved, x;
    int column_tiles = 0;

    struct Work {
        const SubstituteBack& kernel;
        InvertedNode node;
        int first_row, first_column, front, thread;

        /// The columns of L11^-1 begin at the diagonal; y is zero where no front is.
        TOILE_HD int begin() const { return front >= 0 ? first_row : node.width; }
        TOILE_HD int steps() const { return (node.height() - begin() + kDepth - 1) / kDepth; }
        TOILE_HD void load(int step, Stage& stage) const
        {
            // Where the block ends there are zeros instead, and any row for them.
            const int first = begin() + step * kDepth;
            const int k = thread / (kRows / 2), own = first_row + thread % (kRows / 2) * 2;
            const bool is_outside = first + k >= node.height() || own >= node.stride;
            const std::size_t at =
                is_outside ? 0 : node.first_value + std::size_t(first + k) * node.stride + own;
            copy_async(&stage.block[k][thread % (kRows / 2)],
                       reinterpret_cast<const Pair*>(kernel.factor.values.data() + at), is_outside);
            load_columns(
                thread, [&](int r) { return row(first + r < node.height() ? first + r : begin()); }, stage);
        }
        TOILE_HD void add(const Stage& stage, Sums& sums) const { ProductTile::add(thread, stage, sums); }
        TOILE_HD void store(const Sums& sums) const
        {
            for (int i = 0; i < kOwnRows; ++i) {
                const int own = first_row + ProductTile::first_row(thread) + i;
                if (own >= node.width)
                    return;
                double* const to = kernel.x.row(node.first_column + own) + first_column;
                for (int j = 0; j < kOwnColumns; ++j)
                    to[2 * pair(thread, j / 2) + j % 2] = sums.of[i][j];
            }
        }

    private:
        TOILE_HD const double* row(int local) const
        {
            const double* const numbers =
                local < node.width ? kernel.solved.row(front + local)
                                   : kernel.x.row(kernel.factor.rows[node.first_row + local - node.width]);
            return numbers + first_column;
        }
    };

    TOILE_HD Work work(int item, int thread) const { return tile_of_level(*this, item, thread); }
};

} // namespace toile
