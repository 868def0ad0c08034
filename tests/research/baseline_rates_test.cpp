#include <iomanip>
#include <iostream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/coarse_functions.h"
#include "research/linear/jacobi_pcg.h"
#include "research/linear/multigrid.h"
#include "research/linear/subspace_solver.h"
#include "tests/research/baseline_problems.h"

// Convergence rates of the baselines, compared with theory if there is one.

namespace toile::test {

using namespace research;

namespace {

TEST(JacobiPcg, ConvergesToTheDirectSolve)
{
    const Problem problem = stiff_sheet();
    JacobiPcg solver({1e-12, 2000});
    solver.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    EXPECT_LT(energy_error(problem, b, solve(solver, b)), 1e-10);
    EXPECT_LT(solver.iterations(), 700);
}

TEST(JacobiPcg, TreatsCoordinatesIndependently)
{
    // A right-hand side in x alone gives the same x next to any y, which takes more or fewer iterations.
    const Problem problem = with_fixed(cloth_matrix(20, 20, 5.0), {3});
    JacobiPcg solver({0.0, 20});
    solver.update(problem.H, problem.fixed);
    Field both = problem.load(5), alone = both;
    for (Vec3& v : alone)
        v.tail<2>().setZero();
    const Field x = solve(solver, both), x_alone = solve(solver, alone);
    EXPECT_EQ(solver.iterations(), 20);
    for (int i = 0; i < problem.size(); ++i)
        EXPECT_EQ(x_alone[i], Vec3(x[i].x(), 0.0, 0.0));
}

TEST(JacobiPcg, StopsAtItsToleranceAndMapsZeroToZero)
{
    const Problem problem = with_fixed(cloth_matrix(30, 30, 10.0), {3});
    int previous = 0;
    for (const double tolerance : {1e-1, 1e-2, 1e-4}) {
        JacobiPcg solver({tolerance, 1000});
        solver.update(problem.H, problem.fixed);
        solve(solver, problem.load(5));
        EXPECT_GT(solver.iterations(), previous);
        previous = solver.iterations();
        const Field zero(problem.size(), Vec3::Zero());
        EXPECT_EQ(solve(solver, zero), zero);
        EXPECT_EQ(solver.iterations(), 0);
    }
    EXPECT_LT(previous, 200);
}

TEST(Spectrum, BoundsTheEigenvaluesTightly)
{
    const Problem problem = with_fixed(cloth_matrix(24, 20, 10.0), {0, 23});
    const std::vector<double> inverse_diagonal = invert_diagonal(problem.H, problem.fixed);
    const Eigen::VectorXd scale = Eigen::VectorXd(problem.H.diagonal()).cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * Eigen::MatrixXd(problem.H) * scale.asDiagonal();
    const Eigen::VectorXd exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues();
    const SpectralBounds bounds = estimate_bounds(problem.H, inverse_diagonal, 40);
    EXPECT_LT(bounds.lowest, exact[0]);
    EXPECT_GT(bounds.lowest, 0.85 * exact[0]);
    EXPECT_GT(bounds.highest, exact[exact.size() - 1]);
    EXPECT_LT(bounds.highest, 1.06 * exact[exact.size() - 1]);
}

TEST(Spectrum, RefusesAnIndefiniteMatrix)
{
    SparseMatrix saddle = grid_laplacian(6, 6, 0.1);
    saddle.coeffRef(14, 15) = saddle.coeffRef(15, 14) = -50.0;
    const std::vector<double> inverse_diagonal = invert_diagonal(saddle, std::vector<unsigned char>(36, 0));
    EXPECT_THROW(estimate_bounds(saddle, inverse_diagonal, 30), InvalidInput);
}

TEST(Chebyshev, KeepsItsTheoreticalBoundAndComesCloseToIt)
{
    const Problem problem = stiff_sheet();
    for (const int sweeps : {16, 64}) {
        ChebyshevSolver solver({sweeps});
        solver.update(problem.H, problem.fixed);
        const double bound = chebyshev_contraction(solver.bounds(), sweeps);
        const Field b = problem.load(5);
        EXPECT_LE(energy_error(problem, b, solve(solver, b)), bound);
        const double rate = contraction(problem, solver);
        EXPECT_LE(rate, bound);
        EXPECT_GT(rate, 0.97 * bound);
    }
}

TEST(Chebyshev, ConvergesToTheDirectSolve)
{
    const Problem problem = with_fixed(cloth_matrix(40, 40, 5.0), {0, 39});
    ChebyshevSolver solver({400});
    solver.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    EXPECT_LT(energy_error(problem, b, solve(solver, b)), 1e-10);
}

TEST(Chebyshev, IsExactInOneSweepForASingleEigenvalue)
{
    SparseMatrix A(3, 3);
    A.setIdentity();
    A *= 4.0;
    const Problem problem = with_fixed(A, {1});
    ChebyshevSolver solver;
    solver.update(problem.H, problem.fixed);
    const Field b = random_field(3, 2);
    EXPECT_LT(
        (as_matrix(solve(solver, b)) - Eigen::Vector3d(0.25, 1.0, 0.25).asDiagonal() * as_matrix(b)).norm(),
        1e-9);
}

TEST(AggregatedJacobi, OfOrderTwoEqualsTwiceAsManyChebyshevSweeps)
{
    const Problem problem = stiff_sheet();
    AggregatedJacobi aggregated({2, 8});
    ChebyshevSolver chebyshev({16});
    aggregated.update(problem.H, problem.fixed);
    chebyshev.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    const Field x = solve(chebyshev, b);
    EXPECT_LT(energy_norm(problem, difference(solve(aggregated, b), x)), 1e-10 * energy_norm(problem, x));
}

TEST(AggregatedJacobi, WithoutAccelerationEqualsJacobiSweeps)
{
    const Problem problem = with_fixed(cloth_matrix(20, 20, 5.0), {0, 19});
    const Field b = problem.load(5);
    AggregatedJacobi plain({1, 12, false});
    plain.update(problem.H, problem.fixed);
    const Eigen::MatrixX3d expected = as_matrix(solve(plain, b));
    for (const auto& [order, applications] : {std::pair(2, 6), std::pair(3, 4), std::pair(4, 3)}) {
        AggregatedJacobi aggregated({order, applications, false});
        aggregated.update(problem.H, problem.fixed);
        EXPECT_LT((as_matrix(solve(aggregated, b)) - expected).norm(), 1e-12 * expected.norm()) << order;
        EXPECT_GT(aggregated.entry_count(), order * plain.entry_count()) << "reaches more rings";
    }
}

TEST(AggregatedJacobi, KeepsItsTheoreticalBound)
{
    const Problem problem = stiff_sheet();
    const Field b = problem.load(5);
    for (const int order : {1, 2, 3}) {
        AggregatedJacobi solver({order, 16});
        solver.update(problem.H, problem.fixed);
        const double bound = chebyshev_contraction(solver.bounds(), 16);
        EXPECT_LE(energy_error(problem, b, solve(solver, b)), bound) << order;
        const double rate = contraction(problem, solver);
        EXPECT_LE(rate, bound) << order;
        EXPECT_GT(rate, 0.97 * bound) << order;
    }
}

TEST(CoarseFunctions, AreALocalPartitionOfUnity)
{
    const Problem problem = with_fixed(cloth_matrix(30, 30, 5.0), {0, 29});
    const std::vector<double> inverse_diagonal = invert_diagonal(problem.H, problem.fixed);
    const SparseMatrix H = problem.H.pruned(0.0, 0.0);
    const SparseMatrix P = partition_of_unity(H, inverse_diagonal, 40, 1.5);
    EXPECT_EQ(P.cols(), 40);
    const Eigen::VectorXd sums = P * Eigen::VectorXd::Ones(P.cols());
    for (int i = 0; i < problem.size(); ++i)
        EXPECT_NEAR(sums[i], problem.fixed[i] ? 0.0 : 1.0, 1e-14);
    EXPECT_GE(P.coeffs().minCoeff(), 0.0);
    EXPECT_LT(P.nonZeros(), 10 * P.rows());
    EXPECT_EQ(partition_of_unity(H, inverse_diagonal, 5000, 1.5).cols(), 898) << "no more than vertices";
}

TEST(Subspace, BeatsItsSmootherAlone)
{
    const Problem problem = stiff_sheet();
    SubspaceSolver subspace;
    ChebyshevSolver smoother({8}); // as many sweeps
    subspace.update(problem.H, problem.fixed);
    smoother.update(problem.H, problem.fixed);
    EXPECT_LT(contraction(problem, subspace), 0.25);
    EXPECT_GT(contraction(problem, smoother), 0.9);
    EXPECT_LE(pcg_iterations(problem, subspace, 1e-4), 5);
    EXPECT_LE(pcg_iterations(problem, subspace, 1e-8), 8);
}

TEST(Subspace, ContractsMoreWithMoreFunctionsAndMoreSweeps)
{
    const Problem problem = stiff_sheet();
    const auto rate = [&](int functions, int degree) {
        SubspaceSolver solver({functions, degree});
        solver.update(problem.H, problem.fixed);
        return contraction(problem, solver);
    };
    EXPECT_LT(rate(100, 4), 0.6);
    EXPECT_LT(rate(300, 4), rate(100, 4));
    EXPECT_LT(rate(300, 8), rate(300, 4));
}

TEST(Multigrid, ContractsForAnySizeAndStiffness)
{
    for (const auto& [size, reach, rate] : {std::tuple(71, 5.0, 0.5), std::tuple(71, 40.0, 0.5),
                                            std::tuple(71, 500.0, 0.5), std::tuple(140, 40.0, 0.55)}) {
        SCOPED_TRACE(std::to_string(size) + " vertices a side, reach " + std::to_string(reach));
        const Problem problem = with_fixed(cloth_matrix(size, size, reach), {0, size - 1});
        Multigrid solver;
        solver.update(problem.H, problem.fixed);
        EXPECT_GE(solver.level_sizes().size(), 3u);
        EXPECT_LT(contraction(problem, solver), rate);
        EXPECT_LE(pcg_iterations(problem, solver, 1e-4), 7);
        EXPECT_LE(pcg_iterations(problem, solver, 1e-8), 13);
    }
}

TEST(Multigrid, LeavesVerticesWithoutNeighboursToTheSmoother)
{
    // Two sheets, unconnected vertices between them.
    const int n = 40 * 40;
    const SparseMatrix sheet = cloth_matrix(40, 40, 20.0);
    Triplets entries;
    for (int row = 0; row < n; ++row)
        for (SparseMatrix::InnerIterator entry(sheet, row); entry; ++entry)
            for (const int first : {0, n + 7})
                entries.emplace_back(first + row, first + int(entry.col()), entry.value());
    for (int i = n; i < n + 7; ++i)
        entries.emplace_back(i, i, 1e-3);
    SparseMatrix H(2 * n + 7, 2 * n + 7);
    H.setFromTriplets(entries.begin(), entries.end());
    const Problem problem = with_fixed(H, {n + 3});
    Multigrid solver;
    solver.update(problem.H, problem.fixed);
    EXPECT_LT(contraction(problem, solver), 0.5);
}

TEST(Multigrid, IsExactOnASingleLevel)
{
    const Problem problem = with_fixed(cloth_matrix(12, 12, 5.0), {0, 11});
    Multigrid solver;
    solver.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    EXPECT_LT(energy_error(problem, b, solve(solver, b)), 1e-12);
}

// The table of docs/journal/global_solvers.md; run with --gtest_also_run_disabled_tests.

/// Sheet with a two-ring stencil next to the membrane's, of the same size: stiff bending kept in H.
Problem bending_sheet()
{
    const SparseMatrix laplacian = grid_laplacian(71, 71, 0.0);
    return with_fixed(cloth_matrix(71, 71, 40.0) + 0.2 * SparseMatrix(laplacian * laplacian), {0, 70});
}

void print_row(const std::string& name, GlobalSolver& solver, const std::vector<Problem>& problems)
{
    std::cout << "| " << name;
    for (const Problem& problem : problems) {
        solver.update(problem.H, problem.fixed);
        std::cout << " | ";
        if (solver.is_symmetric())
            std::cout << std::setprecision(2) << contraction(problem, solver) << ": ";
        std::cout << pcg_iterations(problem, solver, 1e-4) << " / " << pcg_iterations(problem, solver, 1e-8);
    }
    std::cout << " |" << std::endl;
}

TEST(Baselines, DISABLED_PrintTheTableOfTheDocs)
{
    std::vector<Problem> problems;
    for (const auto& [size, reach] : {std::pair(71, 5.0), std::pair(71, 40.0), std::pair(71, 500.0),
                                      std::pair(140, 40.0), std::pair(224, 40.0)})
        problems.push_back(with_fixed(cloth_matrix(size, size, reach), {0, size - 1}));
    problems.push_back(bending_sheet());

    std::cout << "| Jacobi-PCG alone";
    for (const Problem& problem : problems) {
        std::cout << " | ";
        for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
            JacobiPcg solver({tolerance, 5000});
            solver.update(problem.H, problem.fixed);
            solve(solver, problem.load(5));
            std::cout << solver.iterations() << (tolerance > 1e-8 ? " / " : "");
        }
    }
    std::cout << " |" << std::endl;
    for (const int sweeps : {16, 32, 64}) {
        ChebyshevSolver solver({sweeps});
        print_row("Chebyshev " + std::to_string(sweeps), solver, problems);
    }
    for (const auto& [order, applications] : {std::pair(2, 16), std::pair(3, 16)}) {
        AggregatedJacobi solver({order, applications});
        print_row("A-Jacobi order " + std::to_string(order) + ", " + std::to_string(applications), solver,
                  problems);
    }
    for (const auto& [functions, degree] : {std::pair(300, 4), std::pair(300, 8), std::pair(1000, 4)}) {
        SubspaceSolver solver({functions, degree});
        print_row("Subspace " + std::to_string(functions) + ", degree " + std::to_string(degree), solver,
                  problems);
    }
    for (const int degree : {1, 2, 3}) {
        Multigrid solver({.smoother = {.degree = degree}});
        print_row("Multigrid degree " + std::to_string(degree), solver, problems);
    }
}

} // namespace
} // namespace toile::test
