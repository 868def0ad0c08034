#include "core/quadrature/quadrature_solver.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "core/linear/cholesky.h"
#include "core/linear/inverse_columns.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

TEST(ClusterTree, HoldsEveryNodeOnceInsideItsBalls)
{
    for (const int columns : {1, 3, 8, 23}) {
        const std::vector<EmbeddedPoint> points = grid_points(columns, 17);
        const ClusterTree tree(points, all_nodes(points));
        std::vector<int> found = nodes_below(tree, tree.level_count() - 1, 0);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, all_nodes(points));
        for (int level = 0; level < tree.level_count(); ++level)
            for (int c = 0; c < tree.level_size(level); ++c) {
                const ClusterTree::Cluster& cluster = tree.cluster(tree.first_of_level(level) + c);
                for (const int v : nodes_below(tree, level, c))
                    EXPECT_LE((points[v] - cluster.center).norm(), cluster.radius * (1.0 + 1e-12));
            }
    }
}

TEST(ClusterTree, CutsASquareIntoRoundClusters)
{
    const std::vector<EmbeddedPoint> points = grid_points(64, 64);
    const ClusterTree tree(points, all_nodes(points));
    for (int level = 0; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c) {
            const double nodes = kLeaf * double(1 << level);
            EXPECT_LT(tree.cluster(tree.first_of_level(level) + c).radius, 1.2 * std::sqrt(nodes));
        }
}

TEST(ClusterTree, AcceptsCoincidentNodes)
{
    const std::vector<EmbeddedPoint> points(21, EmbeddedPoint::Ones());
    const ClusterTree tree(points, all_nodes(points));
    EXPECT_EQ(tree.leaf_count(), 3);
    EXPECT_NEAR(tree.cluster(tree.root()).radius, 0.0, 1e-12);
    const ClusterBasis basis(tree, points);
    for (const double value : basis.leaves())
        EXPECT_TRUE(std::isfinite(value));
}

TEST(ClusterTree, HasOneAxisOnALine)
{
    std::vector<EmbeddedPoint> points(40, EmbeddedPoint::Zero());
    for (int v = 0; v < 40; ++v)
        points[v].head<3>() = 0.37 * v * Vec3(1.0, -2.0, 0.5);
    const ClusterTree tree(points, all_nodes(points));
    for (int id = 0; id < tree.cluster_count(); ++id)
        EXPECT_EQ(tree.cluster(id).axes.col(1).norm(), 0.0);
}

/// Expects that the moments preserve the norm of a linear field on every cluster.
void expect_linear_fields_are_reproduced(const std::vector<EmbeddedPoint>& points, Extent extent)
{
    const ClusterTree tree(points, all_nodes(points), extent);
    const ClusterBasis basis(tree, points);
    const auto field = [&](int v) {
        return 0.3 - 0.2 * points[v][0] + 0.7 * points[v][1] + 0.4 * points[v][2];
    };
    std::vector<double> moments(size_t(basis.rank()) * tree.cluster_count());
    const auto value = [&](int slot) { return tree.nodes()[slot] < 0 ? 0.0 : field(tree.nodes()[slot]); };
    for (int level = 0; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c) {
            basis.gather(level, c, 0.0, value, View<double>(moments));
            double squares = 0.0, reproduced = 0.0;
            for (const int v : nodes_below(tree, level, c))
                squares += field(v) * field(v);
            for (int r = 0; r < basis.rank(); ++r)
                reproduced +=
                    std::pow(moments[size_t(basis.rank()) * (tree.first_of_level(level) + c) + r], 2);
            EXPECT_NEAR(reproduced, squares, 1e-9 * squares);
        }
}

TEST(ClusterBasis, ReproducesLinearFieldsExactlyOnEveryCluster)
{
    expect_linear_fields_are_reproduced(grid_points(21, 13), Extent::Surface);
    expect_linear_fields_are_reproduced(grid_points(10, 10, 10), Extent::Volume);
}

TEST(InverseColumns, MatchTheInverse)
{
    const SparseMatrix A = grid_laplacian(19, 14, 0.05);
    const Cholesky cholesky(A);
    const InverseColumns inverse(cholesky.factor());
    const Eigen::MatrixXd exact = Eigen::MatrixXd(A).inverse();
    std::vector<int> columns(InverseColumns::kColumns - 3);
    for (size_t k = 0; k < columns.size(); ++k)
        columns[k] = int(k * 53) % int(A.rows());
    InverseColumns::Block block;
    inverse.solve(columns, block);
    for (int i = 0; i < A.rows(); ++i) {
        for (size_t k = 0; k < columns.size(); ++k)
            EXPECT_NEAR(block[inverse.row_of(i)][int(k)], exact(i, columns[k]), 1e-12 * exact.maxCoeff());
        EXPECT_EQ(block[inverse.row_of(i)][InverseColumns::kColumns - 1], 0.0);
    }
}

TEST(Quadrature, ContractsForAnyRangeOfTheKernel)
{
    const Grid grid;
    for (const double shift : {0.05, 1e-3, 1e-5, 1e-7}) {
        QuadratureSolver solver(grid.points);
        const SparseMatrix H = grid.matrix(shift);
        solver.update(H, grid.fixed);
        EXPECT_LT(contraction(solver, H), 0.45) << shift;
        EXPECT_LT(solver.table().gathers_per_node(), 160.0) << shift;
    }
}

TEST(Quadrature, TendsToTheExactSolution)
{
    const Grid grid;
    const SparseMatrix H = grid.matrix(1e-3);
    double before = 1.0;
    for (const double tolerance : {0.3, 0.1, 0.03, 0.003}) {
        QuadratureSolver solver(grid.points, {tolerance});
        solver.update(H, grid.fixed);
        const double now = contraction(solver, H);
        EXPECT_LT(now, 0.6 * before) << tolerance;
        before = now;
    }
    EXPECT_LT(before, 0.01);
}

TEST(Quadrature, LeavesFixedNodesUnchanged)
{
    Grid grid;
    SparseMatrix H = grid.matrix(1e-3);
    for (const int v : {0, 39, 500, 501, 777}) {
        grid.fixed[v] = 1;
        for (SparseMatrix::InnerIterator entry(H, v); entry; ++entry)
            entry.valueRef() = H.coeffRef(int(entry.col()), v) = entry.col() == v ? 1.0 : 0.0;
    }
    QuadratureSolver solver(grid.points);
    solver.update(H, grid.fixed);
    EXPECT_LT(contraction(solver, H), 0.45);
    std::vector<Vec3> b = random_field(int(H.rows()), 3), x(b.size());
    solver.solve(b, x);
    EXPECT_EQ(x[500], b[500]);
    solver.solve(b, b);
    EXPECT_EQ(x, b) << "in place";
}

TEST(Quadrature, HandlesASingleFreeNodeAndDisconnectedPieces)
{
    // Two decoupled grids, one of them with one free node.
    Grid grid;
    const int n = int(grid.points.size());
    SparseMatrix one = grid.matrix(1e-3), both(2 * n, 2 * n);
    std::vector<Eigen::Triplet<double>> entries;
    for (int row = 0; row < n; ++row) {
        entries.emplace_back(n + row, n + row, row == 5 ? 3.0 : 1.0);
        for (SparseMatrix::InnerIterator entry(one, row); entry; ++entry)
            entries.emplace_back(row, int(entry.col()), entry.value());
    }
    both.setFromTriplets(entries.begin(), entries.end());
    for (int v = 0; v < n; ++v) {
        grid.points.push_back(grid.points[v] + 1e4 * EmbeddedPoint::Unit(0));
        grid.fixed.push_back(v != 5);
    }
    QuadratureSolver solver(grid.points);
    solver.update(both, grid.fixed);
    EXPECT_LT(contraction(solver, both), 0.45);
    std::vector<Vec3> b(2 * n, Vec3::Zero()), x(2 * n);
    b[n + 5] = Vec3(3.0, 6.0, 9.0);
    solver.solve(b, x);
    EXPECT_LT((x[n + 5] - Vec3(1.0, 2.0, 3.0)).norm(), 0.05);
    EXPECT_LT(x[5].norm(), 0.05);
}

TEST(Quadrature, SolvesNothingWhenAllNodesAreFixed)
{
    Grid grid;
    grid.fixed.assign(grid.fixed.size(), 1);
    SparseMatrix identity(long(grid.fixed.size()), long(grid.fixed.size()));
    identity.setIdentity();
    QuadratureSolver solver(grid.points);
    solver.update(identity, grid.fixed);
    const std::vector<Vec3> b = random_field(int(grid.fixed.size()), 3);
    std::vector<Vec3> x(b.size());
    solver.solve(b, x);
    EXPECT_EQ(x, b);
}

TEST(Quadrature, HasTheSameBitsForAnyThreadCount)
{
    const Grid grid;
    const SparseMatrix H = grid.matrix(1e-3);
    const std::vector<Vec3> b = random_field(int(H.rows()), 4);
    std::vector<Vec3> reference;
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        QuadratureSolver solver(grid.points);
        solver.update(H, grid.fixed);
        std::vector<Vec3> x(b.size());
        solver.solve(b, x);
        if (reference.empty())
            reference = x;
        EXPECT_EQ(x, reference) << threads;
    }
}

TEST(Quadrature, CanBeCancelledWhileItIsBuilt)
{
    const Grid grid;
    const Cholesky cholesky(grid.matrix(1e-3));
    const ClusterTree tree(grid.points, all_nodes(grid.points));
    const ClusterBasis basis(tree, grid.points);
    const std::vector<double> diagonal(grid.points.size(), 4.0);
    std::vector<double> fractions;
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    const auto cancelled = build_kernel_table(cholesky.factor(), diagonal, basis, {}, [&](double fraction) {
        fractions.push_back(fraction);
        return fractions.size() < 3;
    });
    EXPECT_FALSE(cancelled.has_value());
    EXPECT_EQ(fractions.size(), 3u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

} // namespace
} // namespace toile::test
