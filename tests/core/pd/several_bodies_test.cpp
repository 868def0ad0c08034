#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/linear/block_diagonal_solver.h"
#include "core/linear/direct_solver.h"
#include "core/pd/energy/sliced_energy.h"

namespace toile::test {

namespace {

/// Chain of n springs of stiffness k, fixed at its first end.
SparseMatrix chain(int n, double k)
{
    Triplets entries;
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, k);
        if (i > 0) {
            entries.emplace_back(i - 1, i - 1, k);
            entries.emplace_back(i, i - 1, -k);
            entries.emplace_back(i - 1, i, -k);
        }
    }
    SparseMatrix H(n, n);
    H.setFromTriplets(entries.begin(), entries.end());
    return H;
}

SparseMatrix side_by_side(const SparseMatrix& A, const SparseMatrix& B, double coupling)
{
    Triplets entries;
    const int first = int(A.rows());
    for (int row = 0; row < A.rows(); ++row)
        for (SparseMatrix::InnerIterator entry(A, row); entry; ++entry)
            entries.emplace_back(row, entry.col(), entry.value());
    for (int row = 0; row < B.rows(); ++row)
        for (SparseMatrix::InnerIterator entry(B, row); entry; ++entry)
            entries.emplace_back(first + row, first + entry.col(), entry.value());
    if (coupling != 0.0)
        entries.emplace_back(0, first, coupling);
    SparseMatrix H(first + int(B.rows()), first + int(B.rows()));
    H.setFromTriplets(entries.begin(), entries.end());
    return H;
}

BlockDiagonalSolver two_blocks(int first, int second)
{
    std::vector<BlockDiagonalSolver::Block> blocks;
    blocks.push_back({consecutive_rows(0, first), std::make_unique<DirectSolver>()});
    blocks.push_back({consecutive_rows(first, second), std::make_unique<DirectSolver>()});
    return BlockDiagonalSolver(std::move(blocks));
}

TEST(BlockDiagonalSolver, SolvesEachBlockByItself)
{
    const SparseMatrix H = side_by_side(chain(5, 3.0), chain(7, 11.0), 0.0);
    BlockDiagonalSolver solver = two_blocks(5, 7);
    const std::vector<unsigned char> fixed(12, 0);
    solver.update(H, fixed);
    solver.begin_step();
    EXPECT_TRUE(solver.is_symmetric());
    std::vector<Vec3> b(12), x(12);
    for (int i = 0; i < 12; ++i)
        b[i] = Vec3(std::sin(i + 1.0), std::cos(2.0 * i), 1.0);
    solver.solve(b, x);
    for (int row = 0; row < 12; ++row)
        EXPECT_LT((row_times(H, row, View<const Vec3>(x)) - b[row]).norm(), 1e-12) << row;
}

TEST(BlockDiagonalSolver, RefusesACouplingOfItsBlocks)
{
    BlockDiagonalSolver solver = two_blocks(3, 3);
    const std::vector<unsigned char> fixed(6, 0);
    EXPECT_THROW(solver.update(side_by_side(chain(3, 1.0), chain(3, 1.0), -0.5), fixed), InvalidInput);
}

/// 1/2 |x_0 - x_1|^2 + x_0.x on two vertices.
class Pair : public Energy {
public:
    std::string_view name() const override { return "test/pair"; }
    void add_hessian(Triplets& H) const override
    {
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                H.emplace_back(i, j, i == j ? 1.0 : -1.0);
    }
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override
    {
        EXPECT_EQ(x.size(), 2);
        const Vec3 d = x[0] - x[1];
        gradient[0] += d + Vec3::UnitX();
        gradient[1] -= d;
        return 0.5 * d.squaredNorm() + x[0].x();
    }
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override
    {
        couplings.emplace_back(0, 1);
    }
    void add_curvature(View<const Vec3> x, Definiteness, BlockWindow K) override
    {
        K.block(0, 1) += x[0].x() * Mat3::Identity();
    }
};

TEST(SlicedEnergy, SeesItsOwnVerticesOnly)
{
    SlicedEnergy sliced(std::make_shared<Pair>(), 3, 2);
    std::vector<Vec3> x(6, Vec3(9, 9, 9)), gradient(6, Vec3::Zero());
    x[3] = Vec3(1, 2, 0);
    x[4] = Vec3(0, 2, 0);
    EXPECT_EQ(sliced.add_gradient(x, gradient), 1.5);
    EXPECT_EQ(gradient[3], Vec3(2, 0, 0));
    EXPECT_EQ(gradient[4], Vec3(-1, 0, 0));
    for (const int other : {0, 1, 2, 5})
        EXPECT_EQ(gradient[other], Vec3(0, 0, 0)) << other;

    Triplets hessian, curvature;
    sliced.add_hessian(hessian);
    sliced.add_constant_curvature(curvature);
    ASSERT_EQ(hessian.size(), 4u);
    EXPECT_EQ(hessian[1].row(), 3);
    EXPECT_EQ(hessian[1].col(), 4);
    EXPECT_EQ(curvature.size(), 4u);

    std::vector<std::pair<int, int>> couplings;
    sliced.add_couplings(couplings);
    ASSERT_EQ(couplings.size(), 1u);
    EXPECT_EQ(couplings[0], std::pair(3, 4));
    BlockMatrix K(6, couplings);
    sliced.add_curvature(x, Definiteness::Exact, K);
    EXPECT_EQ(K.block(3, 4), Mat3(Mat3::Identity()));
}

} // namespace
} // namespace toile::test
