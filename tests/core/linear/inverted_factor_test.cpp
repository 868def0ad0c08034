#include "core/linear/inverted_factor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "core/linear/cholesky.h"
#include "core/linear/inverse_columns.h"
#include "core/linear/inverse_kernels.h"
#include "tests/core/compute/tiles_on_cpu.h"
#include "tests/core/linear/matrices.h"

namespace toile::test {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Columns of the inverse by the GPU kernels: [n][stride], row k belongs to row permutation[k].
std::vector<double> columns_by_kernels(const InvertedFactor& factor, View<const int> rows, int stride)
{
    const ForwardPlan plan = plan_forward(factor, rows);
    std::vector<int> unit_row(rows.begin(), rows.end());
    unit_row.resize(stride, -1);
    std::vector<double> x(size_t(factor.size()) * stride, kNan),
        fronts(size_t(plan.front_rows) * stride, kNan), solved = fronts;
    const ColumnBlock x_block{x.data(), stride}, front_block{fronts.data(), stride},
        solved_block{solved.data(), stride};
    const int column_tiles = stride / ProductTile::kColumns;
    const auto tiles_of = [](const LevelTiles& levels, int level) {
        return View<const RowTile>(levels.tiles)
            .subview(levels.first[level], levels.first[level + 1] - levels.first[level]);
    };
    for (int level = int(plan.tiles.first.size()) - 2; level >= 0; --level) {
        const View<const RowTile> tiles = tiles_of(plan.tiles, level);
        parallel_for(kCpu, "test/assemble", tiles.size() * RowTile::kRows * stride,
                     AssembleFronts{factor.view(), tiles, plan.front_of, unit_row, front_block});
        parallel_tiles(
            kCpu, tiles.size() * column_tiles,
            EliminateNodes{{}, factor.view(), tiles, plan.front_of, front_block, solved_block, column_tiles});
    }
    const LevelTiles tiles = tiles_of_columns(factor);
    for (int level = 0; level < factor.level_count(); ++level)
        parallel_tiles(kCpu, tiles_of(tiles, level).size() * column_tiles,
                       SubstituteBack{{},
                                      factor.view(),
                                      tiles_of(tiles, level),
                                      plan.front_of,
                                      solved_block,
                                      x_block,
                                      column_tiles});
    return x;
}

/// Max difference from InverseColumns [-], relative to the max entry, for these columns of the inverse of A.
double difference(const SparseMatrix& A, const std::vector<int>& targets)
{
    const Cholesky cholesky(A);
    const InvertedFactor factor(cholesky.factor());
    const InverseColumns cpu(cholesky.factor());
    std::vector<int> rows(targets.size());
    std::transform(targets.begin(), targets.end(), rows.begin(),
                   [&](int target) { return target >= 0 ? cpu.row_of(target) : -1; });
    const int stride =
        int(rows.size() + ProductTile::kColumns - 1) / ProductTile::kColumns * ProductTile::kColumns;
    const std::vector<double> x = columns_by_kernels(factor, rows, stride);
    double largest = 0.0, difference = 0.0;
    InverseColumns::Block block;
    for (size_t c = 0; c < targets.size(); ++c) {
        cpu.solve(targets[c] >= 0 ? std::vector<int>{targets[c]} : std::vector<int>{}, block);
        for (int row = 0; row < factor.size(); ++row) {
            largest = std::max(largest, std::abs(block[row][0]));
            const double error = std::abs(x[size_t(row) * stride + c] - block[row][0]);
            difference = std::isnan(error) ? error : std::max(difference, error);
            if (std::isnan(error))
                return error;
        }
    }
    return difference / largest;
}

std::vector<int> some_of(int n, int step)
{
    std::vector<int> targets;
    for (int i = 0; i < n; i += step)
        targets.push_back(i);
    return targets;
}

TEST(InvertedFactor, GivesTheColumnsOfTheInverse)
{
    EXPECT_LT(difference(grid_laplacian(60, 50, 1e-3), some_of(3000, 37)), 1e-13);
    EXPECT_LT(difference(random_spd(300, 3), some_of(300, 2)), 1e-12);
    EXPECT_LT(difference(cloth_matrix(40, 30, 20.0), {5, 6, -1, 7, 600}), 1e-13);
}

TEST(InvertedFactor, HandlesSmallAndDisconnectedMatrices)
{
    for (const int n : {1, 2, 7, 64, 65})
        EXPECT_LT(difference(grid_laplacian(n, 1, 1e-2), some_of(n, 1)), 1e-13) << n;
    SparseMatrix A = grid_laplacian(20, 20, 1e-2);
    for (int row = 0; row < 20; ++row)
        isolate(A, 20 * row + 11);
    isolate(A, 3);
    EXPECT_LT(difference(A, {3, 11, 0, 19, 210}), 1e-13);
}

/// The order of launches relies on the levels.
TEST(InvertedFactor, HasParentsOneLevelAbove)
{
    const InvertedFactor factor(Cholesky(grid_laplacian(60, 50, 1e-3)).factor());
    int columns = 0;
    for (int level = 0; level < factor.level_count(); ++level)
        for (const int k : factor.level(level)) {
            const InvertedNode& node = factor.nodes()[k];
            columns += node.width;
            EXPECT_EQ(node.parent >= 0 ? factor.level_of(node.parent) : -1, level - 1);
            for (int r = 0; r < node.row_count; ++r)
                EXPECT_LT(factor.level_of(factor.node_of_column(factor.rows()[node.first_row + r])), level);
        }
    EXPECT_EQ(columns, 3000);
}

} // namespace
} // namespace toile::test
