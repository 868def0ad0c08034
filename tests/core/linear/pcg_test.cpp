#include "core/linear/pcg.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/linear/cholesky.h"
#include "tests/core/linear/matrices.h"

namespace toile::test {

namespace {

constexpr Pcg::Settings kTight{1e-12, 1000};

void copy(View<const Vec3> from, View<Vec3> to) { std::copy(from.begin(), from.end(), to.begin()); }

/// Grid Laplacian with the maps that Pcg::solve takes.
struct Problem {
    SparseMatrix A = grid_laplacian(20, 15, 0.02);
    Cholesky direct{A};
    std::vector<Vec3> b = random_field(300, 4);
    std::vector<Vec3> x = random_field(300, 9); ///< garbage: solve() starts at zero

    auto multiply() const
    {
        return [this](View<const Vec3> p, View<Vec3> out) {
            for (int i = 0; i < p.size(); ++i)
                out[i] = row_times(A, i, p);
        };
    }
    double error(const std::vector<Vec3>& solution) const
    {
        std::vector<Vec3> exact(b.size());
        direct.solve(b, exact);
        return (as_matrix(solution) - as_matrix(exact)).norm() / as_matrix(exact).norm();
    }
    double residual(const std::vector<Vec3>& solution) const
    {
        return (as_matrix(b) - A * as_matrix(solution)).norm() / as_matrix(b).norm();
    }
};

TEST(Pcg, AgreesWithTheDirectSolve)
{
    Problem problem;
    Pcg pcg;
    const Pcg::Outcome outcome = pcg.solve(problem.multiply(), copy, problem.b, problem.x, kTight);
    EXPECT_LE(outcome.residual, kTight.tolerance);
    EXPECT_LT(outcome.iterations, 300);
    EXPECT_LT(problem.error(problem.x), 1e-10);
}

TEST(Pcg, NeedsOneIterationWithTheExactInverse)
{
    Problem problem;
    Pcg pcg;
    const auto inverse = [&](View<const Vec3> r, View<Vec3> z) { problem.direct.solve(r, z); };
    const Pcg::Outcome outcome = pcg.solve(problem.multiply(), inverse, problem.b, problem.x, kTight);
    EXPECT_EQ(outcome.iterations, 1);
    EXPECT_LT(problem.error(problem.x), 1e-12);
}

TEST(Pcg, EndsAfterOneIterationPerDistinctEigenvalue)
{
    // A diagonal of three values has three, whatever its size.
    const std::vector<Vec3> b = random_field(90, 6);
    std::vector<Vec3> x(90);
    Pcg pcg;
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) {
        for (int i = 0; i < p.size(); ++i)
            out[i] = (1.0 + 4.0 * (i % 3)) * p[i];
    };
    EXPECT_EQ(pcg.solve(multiply, copy, b, x, kTight).iterations, 3);
}

TEST(Pcg, SolvesAZeroRightHandSideWithoutWork)
{
    Problem problem;
    Pcg pcg;
    const std::vector<Vec3> zero(300, Vec3::Zero());
    const auto never = [](View<const Vec3>, View<Vec3>) { ADD_FAILURE() << "nothing to do"; };
    const Pcg::Outcome outcome = pcg.solve(never, never, zero, problem.x, kTight);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_EQ(outcome.residual, 0.0);
    EXPECT_EQ(problem.x, zero);
}

TEST(Pcg, StopsAtTheIterationLimitAndReportsTheResidual)
{
    Problem problem;
    Pcg pcg;
    double previous_error = 1.0;
    for (const int limit : {1, 2, 5, 10}) {
        const Pcg::Outcome outcome =
            pcg.solve(problem.multiply(), copy, problem.b, problem.x, Pcg::Settings{1e-12, limit});
        EXPECT_EQ(outcome.iterations, limit);
        EXPECT_GT(outcome.residual, 1e-12);
        EXPECT_NEAR(outcome.residual, problem.residual(problem.x), 1e-12);
        EXPECT_LT(problem.error(problem.x), previous_error) << "the error of CG falls in every iteration";
        previous_error = problem.error(problem.x);
    }
    EXPECT_EQ(pcg.solve(problem.multiply(), copy, problem.b, problem.x, Pcg::Settings{1e-12, 0}).iterations,
              0);
}

TEST(Pcg, StopsAtTheTolerance)
{
    Problem problem;
    Pcg pcg;
    const Pcg::Outcome loose =
        pcg.solve(problem.multiply(), copy, problem.b, problem.x, Pcg::Settings{0.1, 1000});
    EXPECT_LE(problem.residual(problem.x), 0.1);
    std::vector<Vec3> before(300);
    pcg.solve(problem.multiply(), copy, problem.b, before, Pcg::Settings{0.1, loose.iterations - 1});
    EXPECT_GT(problem.residual(before), 0.1) << "one iteration fewer was not enough";
}

TEST(Pcg, StopsWhenAnIterationGainsLittle)
{
    Problem problem;
    Pcg pcg;
    const auto value = [&] {
        std::vector<Vec3> product(300);
        problem.multiply()(problem.x, product);
        return 0.5 * dot(problem.x, product) - dot(problem.b, problem.x);
    };
    std::vector<double> gains;
    double before = 0.0;
    for (const int limit : {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}) {
        pcg.solve(problem.multiply(), copy, problem.b, problem.x, Pcg::Settings{0.0, limit});
        gains.push_back(before - value());
        before = value();
    }
    for (const double min_gain : {0.3, 0.6, 0.9}) {
        const int taken = pcg.solve(problem.multiply(), copy, problem.b, problem.x,
                                    {.tolerance = 0.0, .max_iterations = 10, .min_gain = min_gain})
                              .iterations;
        double total = 0.0;
        int expected = 0;
        do
            total += gains[expected++];
        while (expected < 10 && gains[expected - 1] > min_gain * total / expected);
        EXPECT_EQ(taken, expected) << min_gain;
        const int late = pcg.solve(problem.multiply(), copy, problem.b, problem.x,
                                   {.tolerance = 0.0,
                                    .max_iterations = 10,
                                    .min_gain = min_gain,
                                    .min_iterations = expected + 2})
                             .iterations;
        EXPECT_GE(late, expected + 2) << min_gain;
    }
}

TEST(Pcg, KeepsItsIterateWhenTheMatrixIsNotPositiveDefinite)
{
    Problem problem;
    Pcg pcg;
    const auto negative = [](View<const Vec3> p, View<Vec3> out) {
        for (int i = 0; i < p.size(); ++i)
            out[i] = -p[i];
    };
    const Pcg::Outcome outcome = pcg.solve(negative, copy, problem.b, problem.x, kTight);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_EQ(outcome.residual, 1.0);
    EXPECT_EQ(problem.x, std::vector<Vec3>(300, Vec3::Zero()));
}

TEST(Pcg, NeedsItsFlexibleFormForAPreconditionerThatChanges)
{
    const SparseMatrix A = grid_laplacian(24, 24, 0.05);
    const int n = int(A.rows());
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) {
        for (int i = 0; i < n; ++i)
            out[i] = row_times(A, i, p);
    };
    const std::vector<Vec3> b = random_field(n, 7);
    const auto residual = [&](bool is_flexible) {
        int call = 0;
        const auto changing = [&](View<const Vec3> r, View<Vec3> z) {
            ++call;
            for (int i = 0; i < n; ++i)
                z[i] = (1.0 + 0.7 * std::sin(1.3 * call * (i + 1))) * r[i];
        };
        std::vector<Vec3> x(n);
        return Pcg().solve(multiply, changing, b, x, {0.0, 40, is_flexible}).residual;
    };
    EXPECT_LT(residual(true), 0.1);
    EXPECT_GT(residual(false), 5.0 * residual(true));
}

} // namespace
} // namespace toile::test
