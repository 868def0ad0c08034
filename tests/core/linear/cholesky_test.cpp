#include "core/linear/cholesky.h"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include "core/compute/parallel.h"
#include "tests/core/linear/matrices.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {
namespace {

/// Solution by Eigen's factorisation: the oracle.
std::vector<Vec3> solve_with_eigen(const SparseMatrix& A, const std::vector<Vec3>& b)
{
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor{Eigen::SparseMatrix<double>(A)};
    EXPECT_EQ(factor.info(), Eigen::Success);
    const Eigen::MatrixX3d solution = factor.solve(as_matrix(b));
    return as_field(solution);
}

double relative_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    return (as_matrix(a) - as_matrix(b)).norm() / as_matrix(b).norm();
}

void expect_solves_like_eigen(const SparseMatrix& A)
{
    const std::vector<Vec3> b = random_field(int(A.rows()), 5);
    std::vector<Vec3> x(b.size());
    Cholesky(A).solve(b, x);
    EXPECT_LT(relative_difference(x, solve_with_eigen(A, b)), 1e-11);
    EXPECT_LT((A * as_matrix(x) - as_matrix(b)).norm(), 1e-11 * as_matrix(b).norm());
}

TEST(Cholesky, SolvesRandomMatricesLikeEigen)
{
    for (const int n : {2, 3, 10, 57, 400})
        for (unsigned seed = 1; seed <= 4; ++seed) {
            SCOPED_TRACE("n = " + std::to_string(n) + ", seed " + std::to_string(seed));
            expect_solves_like_eigen(random_spd(n, seed));
        }
}

TEST(Cholesky, SolvesGridLaplaciansLikeEigen)
{
    // Long, square and wide: supernodes of every width, with and without a remainder of the blocks of eight.
    for (const auto& [columns, rows] : {std::pair(1, 200), std::pair(30, 30), std::pair(61, 47)})
        expect_solves_like_eigen(grid_laplacian(columns, rows, 0.05));
}

TEST(Cholesky, SolvesSubtreesInParallelWithTheSameBits)
{
    const SparseMatrix A = grid_laplacian(250, 250, 1e-3);
    const std::vector<Vec3> b = random_field(int(A.rows()), 7);
    const Cholesky factor(A);
    std::vector<Vec3> one(b.size()), many(b.size());
    {
        const ThreadLimit limit(1);
        factor.solve(b, one);
    }
    EXPECT_LT((A * as_matrix(one) - as_matrix(b)).norm(), 1e-10 * as_matrix(b).norm());
    for (const int threads : {2, 4}) {
        const ThreadLimit limit(threads);
        factor.solve(b, many);
        EXPECT_EQ(as_matrix(one), as_matrix(many)) << threads;
    }
}

TEST(Cholesky, SolvesDenseMatricesLikeEigen)
{
    for (int n = 1; n <= 40; ++n) {
        SparseMatrix A = (Eigen::MatrixXd::Ones(n, n)).sparseView();
        for (int i = 0; i < n; ++i)
            A.coeffRef(i, i) += 1.0 + i;
        SCOPED_TRACE("n = " + std::to_string(n));
        expect_solves_like_eigen(A);
    }
}

TEST(Cholesky, DividesForASingleEntry)
{
    SparseMatrix A(1, 1);
    A.insert(0, 0) = 4.0;
    A.makeCompressed();
    const Cholesky cholesky(A);
    std::vector<Vec3> x{Vec3(8, -2, 1)};
    cholesky.solve(x, x);
    EXPECT_EQ(x[0], Vec3(2, -0.5, 0.25));
    EXPECT_EQ(cholesky.size(), 1);
    EXPECT_EQ(cholesky.factor_entries(), 1);
}

TEST(Cholesky, CopiesIdentityRows)
{
    // As for fixed vertices: their values are copied bit for bit and affect no other row.
    SparseMatrix A = grid_laplacian(12, 9, 0.3);
    for (const int row : {0, 13, 57, 107})
        isolate(A, row);
    const std::vector<Vec3> b = random_field(int(A.rows()), 3);
    std::vector<Vec3> x(b.size()), without(b.size());
    const Cholesky cholesky(A);
    cholesky.solve(b, x);
    std::vector<Vec3> other = b;
    for (const int row : {0, 13, 57, 107}) {
        EXPECT_EQ(x[row], b[row]);
        other[row] *= -1e6;
    }
    cholesky.solve(other, without);
    for (int i = 0; i < int(b.size()); ++i) {
        const bool is_isolated = other[i] != b[i];
        EXPECT_TRUE(is_isolated || x[i] == without[i]) << "row " << i;
    }
}

TEST(Cholesky, SolvesInPlaceWithTheSameBits)
{
    const Cholesky cholesky(grid_laplacian(20, 20, 0.1));
    std::vector<Vec3> b = random_field(400, 8), x(400);
    cholesky.solve(b, x);
    cholesky.solve(b, b);
    EXPECT_EQ(b, x);
}

TEST(Cholesky, RefactorsAMatrixOfTheSamePattern)
{
    SparseMatrix A = grid_laplacian(25, 18, 0.05);
    Cholesky cholesky(A);
    const long entries = cholesky.factor_entries();
    for (const int row : {3, 100, 449})
        isolate(A, row); // zeros stay in the pattern
    A *= 7.0;
    cholesky.refactor(A);
    EXPECT_EQ(cholesky.factor_entries(), entries);

    const std::vector<Vec3> b = random_field(int(A.rows()), 11);
    std::vector<Vec3> x(b.size()), fresh(b.size());
    cholesky.solve(b, x);
    Cholesky(A).solve(b, fresh);
    EXPECT_LT(relative_difference(x, solve_with_eigen(A, b)), 1e-12);
    EXPECT_EQ(x, fresh);
}

TEST(Cholesky, NamesTheRowWhereAMatrixIsNotPositiveDefinite)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.0, -1.0, nan}) {
        SparseMatrix A(3, 3);
        A.setIdentity();
        A.coeffRef(1, 1) = bad;
        const std::string message = message_of([&] { Cholesky cholesky(A); });
        EXPECT_NE(message.find("not positive definite (row 1)"), std::string::npos)
            << bad << " on the diagonal: \"" << message << "\"";
    }

    // Positive diagonal, negative eigenvalue.
    SparseMatrix saddle = grid_laplacian(6, 6, 0.1);
    saddle.coeffRef(14, 15) = saddle.coeffRef(15, 14) = -50.0;
    EXPECT_NE(message_of([&] { Cholesky cholesky(saddle); }).find("(row "), std::string::npos);

    // Independent of the elimination order.
    SparseMatrix grid = grid_laplacian(8, 8, 0.1);
    grid.coeffRef(27, 27) = -1.0;
    const std::string message = message_of([&] { Cholesky cholesky(grid); });
    EXPECT_TRUE(message.find("(row 27)") != std::string::npos) << message;
}

TEST(Cholesky, WorksAgainAfterAMatrixThatWasNotPositiveDefinite)
{
    const SparseMatrix good = grid_laplacian(8, 8, 0.1);
    SparseMatrix bad = good;
    bad.coeffRef(20, 20) = -1.0;
    Cholesky cholesky(good);
    EXPECT_THROW(cholesky.refactor(bad), InvalidInput);

    const std::vector<Vec3> b = random_field(64, 2);
    std::vector<Vec3> x(64), expected(64);
    cholesky.refactor(good);
    cholesky.solve(b, x);
    Cholesky(good).solve(b, expected);
    EXPECT_EQ(x, expected);
}

} // namespace
} // namespace toile::test
