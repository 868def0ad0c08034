#include "core/quadrature/tables/table_kernels.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "core/linear/cholesky.h"
#include "core/linear/inverse_columns.h"
#include "core/quadrature/tables/kernel_table.h"
#include "tests/core/quadrature/kernel_tables.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

/// Columns of the inverse in the slots of leaves.
std::vector<double> slot_columns(const InverseColumns& inverse, View<const int> targets)
{
    std::vector<double> columns(size_t(inverse.size()) * targets.size(), 0.0);
    InverseColumns::Block block;
    for (int c = 0; c < targets.size(); ++c) {
        if (targets[c] < 0)
            continue;
        inverse.solve(targets.subview(c, 1), block);
        for (int row = 0; row < inverse.size(); ++row)
            columns[size_t(row) * targets.size() + c] = block[row][0];
    }
    return columns;
}

std::vector<long> exclusive_sums(const std::vector<int>& numbers)
{
    std::vector<long> sums(numbers.size());
    std::exclusive_scan(numbers.begin(), numbers.end(), sums.begin(), 0L);
    return sums;
}

/// GPU kernels in the order of DeviceTableBuilder, run on the CPU.
class TableByKernels {
public:
    TableByKernels(const SparseMatrix& H, const ClusterBasis& basis, double tolerance)
        : cholesky_(H), inverse_(cholesky_.factor()), basis_(basis), tree_(basis.tree()),
          diagonal_(H.diagonal()), limits_(far_limits(tree_, diagonal(), tolerance))
    {
        table.rank = basis.rank();
        table.near_first.assign(tree_.leaf_count() + 1, 0);
        table.far_first.assign(tree_.leaf_count() + 1, 0);
        for (const int v : tree_.nodes())
            row_of_slot_.push_back(v >= 0 ? inverse_.row_of(v) : -1);
        block_.part_level = std::min(FoundEntries::kLevel, tree_.level_count() - 1);
        block_.parts = tree_.level_size(block_.part_level);
    }

    KernelTable on_cpu(double tolerance) const
    {
        return *build_kernel_table(cholesky_.factor(), diagonal(), basis_, {tolerance}, {});
    }

    void append(int first_leaf, int leaf_count)
    {
        block_.first = first_leaf;
        block_.count = leaf_count;
        const int columns = leaf_count * kLeaf, parts = leaf_count * block_.parts;
        std::vector<double> inverse =
            slot_columns(inverse_, tree_.nodes().subview(first_leaf * kLeaf, columns));
        std::vector<double> moments(size_t(columns) * tree_.cluster_count() * table.rank, NAN);
        std::vector<double> squares(size_t(columns) * tree_.cluster_count(), NAN);
        const SlotColumns slots{row_of_slot_, {inverse.data(), columns}};
        const ClusterColumns clusters{table.rank, {moments.data(), columns}, {squares.data(), columns}};
        for (int level = 0; level < tree_.level_count(); ++level)
            parallel_for(kCpu, "test/moments", tree_.level_size(level) * columns,
                         GatherColumns{basis_.view(), slots, clusters, level, columns});

        std::vector<int> found(parts * FoundEntries::kMax), near(parts + 1), far(parts + 1);
        const FoundEntries entries{found, near, far};
        parallel_for(
            kCpu, "test/find", parts,
            FindEntries{basis_.view(), {tree_.nodes(), diagonal(), limits_}, clusters, block_, entries});
        write(slots, clusters, entries, exclusive_sums(near), exclusive_sums(far));
    }

    KernelTable table;

private:
    void write(const SlotColumns& slots, const ClusterColumns& clusters, const FoundEntries& entries,
               const std::vector<long>& near_sums, const std::vector<long>& far_sums)
    {
        const int first_near = int(table.near_leaf.size()), first_far = int(table.far_cluster.size());
        const EntryOffsets offsets{near_sums, far_sums, first_near, first_far};
        std::vector<int> totals(2);
        parallel_for(kCpu, "test/count", 2, CountEntries{offsets, totals});
        table.near_leaf.resize(first_near + totals[0]);
        table.near_weights.resize(table.near_leaf.size() * KernelTable::kNearWeights);
        table.far_cluster.resize(first_far + totals[1]);
        table.far_weights.resize(table.far_cluster.size() * table.rank * KernelTable::kTargets);
        parallel_for(kCpu, "test/firsts", block_.count + 1,
                     WriteFirsts{offsets, block_, table.near_first, table.far_first});
        parallel_for(kCpu, "test/entries", block_.count * block_.parts,
                     WriteEntries{entries, offsets, table.near_leaf, table.far_cluster});
        parallel_for(kCpu, "test/near", totals[0] * KernelTable::kTargets,
                     WriteNearWeights{slots, block_, first_near, table.near_first, table.near_leaf,
                                      table.near_weights});
        parallel_for(kCpu, "test/far", totals[1] * KernelTable::kTargets,
                     WriteFarWeights{clusters, block_, first_far, table.far_first, table.far_cluster,
                                     table.far_weights});
    }
    View<const double> diagonal() const { return {diagonal_.data(), int(diagonal_.size())}; }

    const Cholesky cholesky_;
    const InverseColumns inverse_;
    const ClusterBasis& basis_;
    const ClusterTree& tree_;
    Eigen::VectorXd diagonal_;
    std::vector<double> limits_;
    std::vector<int> row_of_slot_;
    LeafBlock block_;
};

/// Builds with blocks of so many leaves and compares with build_kernel_table.
void expect_tables_of_the_cpu(const SparseMatrix& H, const std::vector<EmbeddedPoint>& points,
                              const std::vector<int>& nodes, Extent extent, double tolerance, int block)
{
    const ClusterTree tree(points, nodes, extent);
    const ClusterBasis basis(tree, points);
    TableByKernels kernels(H, basis, tolerance);
    for (int first = 0; first < tree.leaf_count(); first += block)
        kernels.append(first, std::min(block, tree.leaf_count() - first));
    expect_equal_tables(kernels.table, kernels.on_cpu(tolerance));
}

TEST(TableKernels, MatchTheTablesOfTheCpu)
{
    const Grid grid;
    expect_tables_of_the_cpu(grid.matrix(1e-3), grid.points, all_nodes(grid.points), Extent::Surface, 0.2,
                             17);
    const std::vector<EmbeddedPoint> cube = grid_points(8, 8, 8);
    expect_tables_of_the_cpu(grid_laplacian(8, 64, 1e-1), cube, all_nodes(cube), Extent::Volume, 0.07, 64);
}

TEST(TableKernels, HandleTreesOfAnyHeight)
{
    for (const int columns : {1, 8, 9, 129, 300})
        expect_tables_of_the_cpu(grid_laplacian(columns, 1, 1e-2), grid_points(columns, 1),
                                 all_nodes(grid_points(columns, 1)), Extent::Surface, 0.2, 3);
}

TEST(TableKernels, SkipFixedNodes)
{
    Grid grid;
    SparseMatrix H = grid.matrix(1e-2);
    std::vector<int> nodes;
    for (int v = 0; v < int(grid.points.size()); ++v)
        v % 7 == 0 ? isolate(H, v) : nodes.push_back(v);
    expect_tables_of_the_cpu(H, grid.points, nodes, Extent::Surface, 0.2, 32);
}

} // namespace
} // namespace toile::test
