#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/compute/parallel.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/jacobi_pcg.h"
#include "research/linear/multigrid.h"
#include "research/linear/subspace_solver.h"
#include "tests/core/mesh/meshes.h"
#include "tests/research/baseline_problems.h"

// Common requirements on all baselines of the global solve.

namespace toile::test {

using namespace research;

namespace {

using MakeSolver = std::function<std::unique_ptr<GlobalSolver>()>;

struct Named {
    std::string name;
    MakeSolver make;
};
std::ostream& operator<<(std::ostream& out, const Named& named) { return out << named.name; }

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

TEST_P(Baseline, CopiesFixedVerticesAndDecouplesThem)
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

TEST_P(Baseline, CopiesEverythingWhenAllVerticesAreFixed)
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

TEST_P(Baseline, AcceptsNewValuesAndNewPatterns)
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

TEST_P(Baseline, IsLinearSymmetricAndPositiveAsDeclared)
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

} // namespace
} // namespace toile::test
