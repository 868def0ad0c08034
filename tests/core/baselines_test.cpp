#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/backend/parallel.h"
#include "core/linear/baselines/aggregated_jacobi.h"
#include "core/linear/baselines/chebyshev_solver.h"
#include "core/linear/baselines/coarse_functions.h"
#include "core/linear/baselines/jacobi_pcg.h"
#include "core/linear/baselines/multigrid.h"
#include "core/linear/baselines/subspace_solver.h"
#include "core/linear/cholesky.h"
#include "core/linear/pcg.h"
#include "tests/core/matrices.h"
#include "tests/core/meshes.h"

namespace toile::test {
namespace {

using Field = std::vector<Vec3>;
using MakeSolver = std::function<std::unique_ptr<GlobalSolver>()>;

/// A matrix with some vertices fixed.
struct Problem {
    SparseMatrix H;
    std::vector<unsigned char> fixed;

    int size() const { return int(fixed.size()); }

    /// Random, zero at fixed vertices.
    Field load(unsigned seed) const
    {
        Field b = random_field(size(), seed);
        for (int i = 0; i < size(); ++i)
            if (fixed[i])
                b[i].setZero();
        return b;
    }
    Field times(const Field& x) const { return as_field(H * as_matrix(x)); }
};

Problem with_fixed(SparseMatrix H, const std::vector<int>& fixed)
{
    Problem problem{std::move(H), {}};
    problem.fixed.assign(problem.H.rows(), 0);
    for (const int i : fixed) {
        problem.fixed[i] = 1;
        isolate(problem.H, i);
    }
    return problem;
}

/// A sheet of 71 x 71 vertices on two pins whose stretch waves travel 40 edges in a time step.
Problem stiff_sheet() { return with_fixed(cloth_matrix(71, 71, 40.0), {0, 70}); }

Field solve(const GlobalSolver& solver, const Field& b)
{
    Field x(b.size(), Vec3::Constant(-1.0));
    solver.solve(b, x);
    return x;
}

Field difference(const Field& a, const Field& b) { return as_field(as_matrix(a) - as_matrix(b)); }

double energy_norm(const Problem& problem, const Field& x) { return std::sqrt(dot(x, problem.times(x))); }

/// |x - H^-1 b| / |H^-1 b| in the norm of H.
double energy_error(const Problem& problem, const Field& b, const Field& x)
{
    Field exact(b.size());
    Cholesky(problem.H).solve(b, exact);
    return energy_norm(problem, difference(x, exact)) / energy_norm(problem, exact);
}

/// Spectral radius of the iteration x += S (b - H x), by its power.
double contraction(const Problem& problem, const GlobalSolver& solver)
{
    Field error = problem.load(3);
    double factor = 0.0;
    for (int k = 0; k < 30; ++k) {
        const double before = energy_norm(problem, error);
        error = difference(error, solve(solver, problem.times(error)));
        factor = energy_norm(problem, error) / before;
    }
    return factor;
}

/// Iterations of conjugate gradients around the solver until |r| / |b| <= tolerance, from white noise.
int pcg_iterations(const Problem& problem, const GlobalSolver& solver, double tolerance)
{
    const Field b = problem.load(5);
    Field x(b.size());
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) {
        for (int i = 0; i < p.size(); ++i)
            out[i] = row_times(problem.H, i, p);
    };
    const auto precondition = [&](View<const Vec3> r, View<Vec3> z) { solver.solve(r, z); };
    return Pcg().solve(multiply, precondition, b, x, {tolerance, 2000, !solver.is_symmetric()}).iterations;
}

// What every baseline promises.

struct Named {
    std::string name;
    MakeSolver make;
};
void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }

template <typename Solver>
Named named(const std::string& name)
{
    return {name, [] { return std::make_unique<Solver>(); }};
}

class Baseline : public testing::TestWithParam<Named> {
protected:
    std::unique_ptr<GlobalSolver> updated(const Problem& problem) const
    {
        std::unique_ptr<GlobalSolver> solver = GetParam().make();
        solver->update(problem.H, problem.fixed);
        return solver;
    }
};

INSTANTIATE_TEST_SUITE_P(All, Baseline,
                         testing::Values(named<JacobiPcg>("JacobiPcg"), named<ChebyshevSolver>("Chebyshev"),
                                         named<AggregatedJacobi>("AggregatedJacobi"),
                                         named<SubspaceSolver>("Subspace"), named<Multigrid>("Multigrid")),
                         [](const auto& test) { return test.param.name; });

TEST_P(Baseline, ReducesTheErrorOfWhiteNoise)
{
    for (const Problem& problem : {stiff_sheet(), with_fixed(grid_laplacian(60, 50, 0.01), {7, 1300})}) {
        const auto solver = updated(problem);
        const Field b = problem.load(5);
        EXPECT_LT(energy_error(problem, b, solve(*solver, b)), 0.9);
    }
}

TEST_P(Baseline, HasTheSameBitsForEveryThreadCount)
{
    const Problem problem = stiff_sheet();
    const Field b = problem.load(5);
    Field one;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const auto solver = updated(problem);
        const Field x = solve(*solver, b);
        EXPECT_TRUE(threads == 1 || x == one) << threads;
        one = x;
    }
}

TEST_P(Baseline, HandsFixedVerticesThroughAndKeepsThemApart)
{
    const std::vector<int> fixed{0, 13, 57, 107};
    const Problem problem = with_fixed(cloth_matrix(12, 9, 3.0), fixed);
    const auto solver = updated(problem);
    const Field b = random_field(problem.size(), 3);
    Field other = b;
    for (const int i : fixed)
        other[i] *= -1e6;
    const Field x = solve(*solver, b), y = solve(*solver, other);
    for (int i = 0; i < problem.size(); ++i) {
        if (problem.fixed[i])
            EXPECT_EQ(x[i], b[i]);
        else
            EXPECT_EQ(x[i], y[i]) << "vertex " << i << " feels fixed ones";
    }
}

TEST_P(Baseline, HandsEverythingThroughWhereEverythingIsFixed)
{
    const Problem problem = with_fixed(grid_laplacian(2, 2, 0.1), {0, 1, 2, 3});
    const Field b = random_field(4, 3);
    EXPECT_EQ(solve(*updated(problem), b), b);
}

TEST_P(Baseline, SolvesInPlaceWithTheSameBits)
{
    const Problem problem = with_fixed(grid_laplacian(20, 20, 0.1), {5});
    const auto solver = updated(problem);
    Field b = random_field(400, 8);
    const Field x = solve(*solver, b);
    solver->solve(b, b);
    EXPECT_EQ(b, x);
}

TEST_P(Baseline, TakesNewValuesAndNewPatterns)
{
    auto solver = GetParam().make();
    for (const Problem& problem :
         {with_fixed(cloth_matrix(20, 20, 10.0), {}), with_fixed(cloth_matrix(20, 20, 2.0), {3, 100}),
          with_fixed(grid_laplacian(31, 12, 0.1), {17})}) {
        solver->update(problem.H, problem.fixed);
        const Field b = random_field(problem.size(), 8);
        EXPECT_EQ(solve(*solver, b), solve(*updated(problem), b));
    }
}

TEST_P(Baseline, IsLinearSymmetricAndPositiveWhereItSaysSo)
{
    const Problem problem = stiff_sheet();
    const auto solver = updated(problem);
    if (!solver->is_symmetric())
        GTEST_SKIP() << "does not say so";
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Field a = random_field(problem.size(), seed), b = random_field(problem.size(), seed + 10);
        const Field Sa = solve(*solver, a), Sb = solve(*solver, b);
        EXPECT_GT(dot(a, Sa), 0.0);
        EXPECT_NEAR(dot(a, Sb), dot(b, Sa), 1e-11 * std::sqrt(dot(a, Sa) * dot(b, Sb)));

        const Field sum = solve(*solver, as_field(2.0 * as_matrix(a) - 3.0 * as_matrix(b)));
        const Eigen::MatrixX3d expected = 2.0 * as_matrix(Sa) - 3.0 * as_matrix(Sb);
        EXPECT_LT((as_matrix(sum) - expected).norm(), 1e-11 * expected.norm());
    }
}

TEST_P(Baseline, NamesTheRowWhoseDiagonalIsNotPositive)
{
    Problem problem = with_fixed(grid_laplacian(8, 8, 0.1), {});
    problem.H.coeffRef(27, 27) = -1.0;
    const std::string message = message_of([&] { updated(problem); });
    EXPECT_NE(message.find("not positive definite (row 27)"), std::string::npos) << message;
}

// Each one's own rate, against theory where there is one.

TEST(JacobiPcg, ConvergesToTheDirectSolve)
{
    const Problem problem = stiff_sheet();
    JacobiPcg solver({1e-12, 2000});
    solver.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    EXPECT_LT(energy_error(problem, b, solve(solver, b)), 1e-10);
    EXPECT_LT(solver.iterations(), 700);
}

TEST(JacobiPcg, RunsOneMethodForEachOfXYZ)
{
    // A right-hand side in x alone gives the same x next to any y, which takes longer or shorter.
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

TEST(JacobiPcg, StopsAtItsToleranceAndAnswersZeroWithZero)
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

TEST(Chebyshev, IsExactInOneSweepWhereTheIntervalIsAPoint)
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

TEST(CoarseFunctions, AddUpToOneAndStayLocal)
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

TEST(Multigrid, ContractsWhateverTheSizeAndTheStiffness)
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
    // Two sheets, loose vertices between them.
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

TEST(Multigrid, IsExactWhereTheFinestLevelIsTheCoarsest)
{
    const Problem problem = with_fixed(cloth_matrix(12, 12, 5.0), {0, 11});
    Multigrid solver;
    solver.update(problem.H, problem.fixed);
    const Field b = problem.load(5);
    EXPECT_LT(energy_error(problem, b, solve(solver, b)), 1e-12);
}

} // namespace
} // namespace toile::test
