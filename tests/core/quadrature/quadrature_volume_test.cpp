#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "core/quadrature/quadrature_solver.h"
#include "tests/core/quadrature/quadrature_problems.h"

namespace toile::test {
namespace {

/// Block of n x n x n nodes: seven-point Laplacian plus `shift` times the identity.
struct Cube {
    int n;
    std::vector<EmbeddedPoint> points = grid_points(n, n, n);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(points.size(), 0);

    SparseMatrix matrix(double shift) const
    {
        Triplets entries;
        for (int a = 0; a < n * n * n; ++a) {
            entries.emplace_back(a, a, shift);
            const int i = a % n, j = a / n % n, k = a / (n * n);
            if (i + 1 < n)
                connect(a, a + 1, entries);
            if (j + 1 < n)
                connect(a, a + n, entries);
            if (k + 1 < n)
                connect(a, a + n * n, entries);
        }
        SparseMatrix A(n * n * n, n * n * n);
        A.setFromTriplets(entries.begin(), entries.end());
        return A;
    }
};

/// Settings for tables of a volume, as for a scene of tetrahedra.
constexpr QuadratureSolver::Settings kVolume{{0.07}, Extent::Volume};

TEST(QuadratureOfVolumes, ContractsFasterWithShorterListsThanThreeFunctions)
{
    const Cube cube{10};
    for (const double shift : {1e-2, 1e-4}) {
        const SparseMatrix H = cube.matrix(shift);
        QuadratureSolver four(cube.points, kVolume), three(cube.points, {kVolume.kernel, Extent::Surface});
        four.update(H, cube.fixed);
        three.update(H, cube.fixed);
        const double contraction_of_four = contraction(four, H);
        EXPECT_LT(contraction_of_four, 0.2) << shift;
        EXPECT_LT(contraction_of_four, contraction(three, H)) << shift;
        EXPECT_LT(four.table().gathers_per_node(), 0.85 * three.table().gathers_per_node()) << shift;
    }
}

TEST(QuadratureOfVolumes, ContractsForAnySize)
{
    for (const int n : {7, 14}) {
        const Cube cube{n};
        const SparseMatrix H = cube.matrix(1e-2);
        QuadratureSolver solver(cube.points, kVolume);
        solver.update(H, cube.fixed);
        EXPECT_LT(contraction(solver, H), 0.35) << n;
    }
}

/// Dense matrix of a table: near blocks, and far blocks times the functions of their cluster.
Eigen::MatrixXd dense(const QuadratureTables& tables)
{
    const ClusterTree& tree = tables.tree;
    const KernelTable& kernel = tables.kernel;
    constexpr int kLeaf = ClusterTree::kLeaf;
    const int slots = tree.nodes().size(), rank = kernel.rank;

    // Functions of every cluster at every slot, [rank * clusters x slots]: moments of unit fields.
    Eigen::MatrixXd functions(rank * tree.cluster_count(), slots);
    std::vector<double> moments(functions.rows());
    for (int slot = 0; slot < slots; ++slot) {
        for (int level = 0; level < tree.level_count(); ++level)
            for (int c = 0; c < tree.level_size(level); ++c)
                tables.basis.gather(
                    level, c, 0.0, [&](int s) { return s == slot ? 1.0 : 0.0; }, View<double>(moments));
        functions.col(slot) = Eigen::Map<Eigen::VectorXd>(moments.data(), functions.rows());
    }
    Eigen::MatrixXd by_slot = Eigen::MatrixXd::Zero(slots, slots);
    for (int leaf = 0; leaf < tree.leaf_count(); ++leaf)
        for (int t = 0; t < kLeaf; ++t) {
            const int target = leaf * kLeaf + t;
            for (int e = kernel.near_first[leaf]; e < kernel.near_first[leaf + 1]; ++e)
                for (int j = 0; j < kLeaf; ++j)
                    by_slot(target, kernel.near_leaf[e] * kLeaf + j) +=
                        kernel.near_weights[size_t(e) * KernelTable::kNearWeights + j * kLeaf + t];
            for (int e = kernel.far_first[leaf]; e < kernel.far_first[leaf + 1]; ++e)
                for (int r = 0; r < rank; ++r)
                    by_slot.row(target) += kernel.far_weights[(size_t(e) * rank + r) * kLeaf + t] *
                                           functions.row(kernel.far_cluster[e] * rank + r);
        }
    Eigen::MatrixXd by_node = Eigen::MatrixXd::Zero(slots, slots); // rows and columns of padding stay zero
    for (int i = 0; i < slots; ++i)
        for (int j = 0; j < slots; ++j)
            if (tree.nodes()[i] >= 0 && tree.nodes()[j] >= 0)
                by_node(tree.nodes()[i], tree.nodes()[j]) = by_slot(i, j);
    return by_node;
}

TEST(QuadratureOfVolumes, AppliesTheMatrixOfItsTable)
{
    const Cube cube{9};
    const int n = int(cube.points.size());
    const auto tables = build_tables({cube.matrix(1e-2), cube.fixed, cube.points, kVolume}, nullptr);
    ASSERT_EQ(tables->kernel.rank, 4);
    ASSERT_FALSE(tables->kernel.far_cluster.empty());
    const std::vector<Vec3> b = random_field(n, 8);
    std::vector<Vec3> x(n);
    QuadratureOperator(tables).solve(b, x);
    const Eigen::MatrixX3d expected = dense(*tables).topLeftCorner(n, n) * as_matrix(b);
    EXPECT_LT((as_matrix(x) - expected).cwiseAbs().maxCoeff(), 1e-5 * expected.cwiseAbs().maxCoeff());
}

} // namespace
} // namespace toile::test
