#pragma once

#include <cstddef>

#include "core/compute/async_copy.h"
#include "core/linear/forward_plan.h"

/// Kernels for columns of A^-1 from an InvertedFactor, launched level by level by DeviceInverseColumns.
namespace toile {

/// Rows of equal length, with one entry for every column of the inverse that is solved for.
struct ColumnBlock {
    double* data = nullptr;
    int stride = 0;

    TOILE_HD double* row(int i) const { return data + std::size_t(i) * stride; }
};

/// Assembles the fronts of nodes before their elimination: unit vectors, plus the children's updates in their
/// order. Item i is a column of a row of a tile.
struct AssembleFronts {
    InvertedFactorView factor;
    View<const RowTile> tiles; ///< of one level
    View<const int> front_of;  ///< [nodes]
    View<const int> unit_row;  ///< [columns] row of a column's 1, -1 if it has none
    ColumnBlock fronts;

    TOILE_HD void operator()(int i) const
    {
        const int column = i % unit_row.size();
        const RowTile tile = tiles[i / unit_row.size() / RowTile::kRows];
        const InvertedNode& node = factor.nodes[tile.node];
        const int local = tile.first_row + i / unit_row.size() % RowTile::kRows;
        if (local >= node.height())
            return;
        const bool is_pivot = local < node.width;
        const int row =
            is_pivot ? node.first_column + local : factor.rows[node.first_row + local - node.width];
        double sum = is_pivot && unit_row[column] == row ? 1.0 : 0.0;
        for (int c = factor.first_child[tile.node]; c < factor.first_child[tile.node + 1]; ++c)
            if (const int child = factor.children[c]; front_of[child] >= 0)
                sum += passed_on(child, row, column);
        fronts.row(front_of[tile.node] + local)[column] = sum;
    }

private:
    /// Update of a matrix row from a child's front.
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

/// Tile of a product of a node's block with rows of columns: kRows x kColumns numbers. A thread computes
/// kThreadRows x kThreadColumns of them.
struct ProductTile {
    static constexpr int kRows = RowTile::kRows;
    static constexpr int kColumns = 128;
    static constexpr int kDepth = 8; ///< summands of a step
    static constexpr int kThreads = 128;
    static constexpr int kThreadRows = 8, kThreadColumns = 4;
    static_assert(kThreads * kThreadRows * kThreadColumns == kRows * kColumns);
    static_assert(kThreads == kDepth * kRows / 2); // SubstituteBack loads a pair of the block per thread

    /// Two numbers: one load of 16 bytes.
    struct alignas(16) Pair {
        double value[2];
    };
    struct Stage {
        Pair block[kDepth][kRows / 2];
        Pair columns[kDepth][kColumns / 2];
    };
    struct Sums {
        double of[kThreadRows][kThreadColumns];
    };

    // Threads of a tile: a warp has 16 x 64 of its numbers. A thread's columns are two pairs, so that 16
    // adjacent threads read 256 contiguous bytes.
    TOILE_HD static int first_row(int thread) { return (thread / 64 * 2 + thread / 16 % 2) * kThreadRows; }
    TOILE_HD static int pair(int thread, int k) { return thread / 32 % 2 * 32 + k * 16 + thread % 16; }

    /// Loads the rows of a step into the stage, half a row per warp.
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
            double a[kThreadRows], b[kThreadColumns];
            for (int i = 0; i < kThreadRows / 2; ++i) {
                const Pair two = stage.block[k][first_row(thread) / 2 + i];
                a[2 * i] = two.value[0];
                a[2 * i + 1] = two.value[1];
            }
            for (int j = 0; j < kThreadColumns / 2; ++j) {
                const Pair two = stage.columns[k][pair(thread, j)];
                b[2 * j] = two.value[0];
                b[2 * j + 1] = two.value[1];
            }
            for (int i = 0; i < kThreadRows; ++i)
                for (int j = 0; j < kThreadColumns; ++j)
                    sums.of[i][j] += a[i] * b[j];
        }
    }
};

/// Work of a thread in tile `item` of a level's products: each tile of rows with all tiles of columns.
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

/// Forward substitution with one level's nodes. Stores y_pivot = L11^-1 c_pivot in `solved`. Adds
/// -L21 y_pivot = (-L21 L11^-1) c_pivot to the rows below in the fronts.
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

        /// Number of summands: rows of L11^-1 end at the diagonal of the tile's last row.
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
                    const int pivot = step * kDepth + k;
                    return kernel.fronts.row(front + (pivot < node.width ? pivot : 0)) + first_column;
                },
                stage);
        }
        TOILE_HD void add(const Stage& stage, Sums& sums) const { ProductTile::add(thread, stage, sums); }
        TOILE_HD void store(const Sums& sums) const
        {
            for (int i = 0; i < kThreadRows; ++i) {
                const int local = first_row + ProductTile::first_row(thread) + i;
                if (local >= node.height())
                    return;
                const bool is_pivot = local < node.width;
                double* const row =
                    (is_pivot ? kernel.solved : kernel.fronts).row(front + local) + first_column;
                for (int j = 0; j < kThreadColumns; ++j) {
                    double& number = row[2 * pair(thread, j / 2) + j % 2];
                    number = is_pivot ? sums.of[i][j] : number + sums.of[i][j];
                }
            }
        }
    };

    TOILE_HD Work work(int item, int thread) const { return tile_of_level(*this, item, thread); }
};

/// Back substitution with one level's nodes: x_pivot = L11^-T y_pivot + (-L21 L11^-1)^T x_below.
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

        /// First row with summands: columns of L11^-1 begin at the diagonal. y is zero in nodes
        /// without a front.
        TOILE_HD int begin() const { return front >= 0 ? first_row : node.width; }
        TOILE_HD int steps() const { return (node.height() - begin() + kDepth - 1) / kDepth; }
        TOILE_HD void load(int step, Stage& stage) const
        {
            // Beyond the end of the block, load zeros and any row for them.
            const int first = begin() + step * kDepth;
            const int k = thread / (kRows / 2), pivot = first_row + thread % (kRows / 2) * 2;
            const bool is_outside = first + k >= node.height() || pivot >= node.stride;
            const std::size_t at =
                is_outside ? 0 : node.first_value + std::size_t(first + k) * node.stride + pivot;
            copy_async(&stage.block[k][thread % (kRows / 2)],
                       reinterpret_cast<const Pair*>(kernel.factor.values.data() + at), is_outside);
            load_columns(
                thread, [&](int r) { return row(first + r < node.height() ? first + r : begin()); }, stage);
        }
        TOILE_HD void add(const Stage& stage, Sums& sums) const { ProductTile::add(thread, stage, sums); }
        TOILE_HD void store(const Sums& sums) const
        {
            for (int i = 0; i < kThreadRows; ++i) {
                const int pivot = first_row + ProductTile::first_row(thread) + i;
                if (pivot >= node.width)
                    return;
                double* const to = kernel.x.row(node.first_column + pivot) + first_column;
                for (int j = 0; j < kThreadColumns; ++j)
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
