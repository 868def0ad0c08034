#include "core/pd/minimiser/lbfgs.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/core/pd/objectives.h"

namespace toile::test {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Lbfgs, SolvesAQuadraticInOneIterationWithTheExactInverse)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-10, 50});
    EXPECT_TRUE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 1);
    EXPECT_EQ(objective.evaluated, 2) << "the start and one trial";
    EXPECT_EQ(objective.accepted, 2) << "the start and one point";
    EXPECT_LT(max_distance(x, objective.center), 1e-12);
    EXPECT_LT(outcome.gradient_norm, 1e-11);
    EXPECT_NEAR(outcome.value, 0.0, 1e-20);
}

TEST(Lbfgs, EndsWithAMoveWithinTheTolerance)
{
    // With the exact inverse the next move is the whole way to the minimum. It is applied but not counted as
    // an iteration.
    Quadratic objective;
    std::vector<Vec3> start = objective.center;
    start[37] += Vec3(0.003, 0.0, 0.004);
    Lbfgs lbfgs;

    std::vector<Vec3> x = start;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {0.005001, 50});
    EXPECT_TRUE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_NEAR(outcome.displacement, 0.005, 1e-12);
    EXPECT_EQ(objective.evaluated, 2) << "the start and where it ends";
    EXPECT_LT(max_distance(x, objective.center), 1e-12);

    x = start;
    const Lbfgs::Outcome moved = lbfgs.minimise(objective, x, {0.004999, 50});
    EXPECT_TRUE(moved.converged);
    EXPECT_EQ(moved.iterations, 1);
    EXPECT_LT(max_distance(x, objective.center), 1e-12);

    const std::vector<Vec3> end = x;
    EXPECT_EQ(lbfgs.minimise(objective, x, {1.0, 50}).iterations, 0);
    EXPECT_EQ(x, end) << "a move of nothing is not made";
}

TEST(Lbfgs, StopsAtTheIterationLimit)
{
    /// Quadratic without its inverse: many iterations.
    class Slow : public Quadratic {
    public:
        void precondition(View<const Vec3> g, View<Vec3> z) override { copy(g, z); }
    };
    Slow objective;
    Lbfgs lbfgs;
    std::vector<Vec3> x = random_field(100, 3);
    const Lbfgs::Outcome cut = lbfgs.minimise(objective, x, {1e-9, 7});
    EXPECT_FALSE(cut.converged);
    EXPECT_EQ(cut.iterations, 7);
    EXPECT_GT(cut.displacement, 1e-9);

    EXPECT_TRUE(lbfgs.minimise(objective, x, {1e-9, 500}).converged);
    EXPECT_LT(max_distance(x, objective.center),
              1e-7); // min eigenvalue 0.1, gradients of about the tolerance

    const std::vector<Vec3> before = random_field(100, 4);
    x = before;
    EXPECT_EQ(lbfgs.minimise(objective, x, {1e-9, 0}).iterations, 0);
    EXPECT_EQ(x, before);
}

TEST(Lbfgs, FollowsACurvedValleyToItsEnd)
{
    Valley objective;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.3, 1.5, 2.0)};
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-10, 1000});
    EXPECT_TRUE(outcome.converged);
    EXPECT_LT(outcome.iterations, 300);
    EXPECT_LT(outcome.value, 1e-16);
    EXPECT_LT(max_distance(x, std::vector<Vec3>(3, Vec3::Ones())), 1e-7);
    EXPECT_EQ(objective.accepted, outcome.iterations + 2) << "the start and the last move";
}

TEST(Lbfgs, NeverRaisesTheValue)
{
    Valley objective;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)}, ignored(1);
    Lbfgs lbfgs;
    double previous = objective.evaluate(x, ignored);
    for (int iteration = 0; iteration < 60; ++iteration) {
        const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-14, 3});
        EXPECT_LE(outcome.value, previous * (1.0 + 1e-13));
        EXPECT_EQ(outcome.value, objective.evaluate(x, ignored)) << "the value belongs to x";
        previous = outcome.value;
    }
}

TEST(Lbfgs, LeavesANonFiniteStartUnchanged)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    x[50].z() = kNaN;
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-10, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_FALSE(std::isfinite(outcome.value));
    EXPECT_EQ(objective.evaluated, 1);
    EXPECT_TRUE(std::isnan(outcome.gradient_norm));
}

TEST(Lbfgs, BacktracksFromNonFiniteValues)
{
    /// x - log x in every coordinate: not a number for x <= 0, where full steps from large x end.
    class Barrier : public Counting {
    public:
        double evaluate(View<const Vec3> x, View<Vec3> gradient) override
        {
            gradient[0] = Vec3::Ones() - x[0].cwiseInverse();
            return x[0].sum() - x[0].array().log().sum();
        }
        void precondition(View<const Vec3> g, View<Vec3> z) override { z[0] = 4.0 * g[0]; }
    };
    Barrier objective;
    std::vector<Vec3> x{Vec3(3.0, 2.0, 0.5)};
    Lbfgs lbfgs;
    EXPECT_TRUE(lbfgs.minimise(objective, x, {1e-9, 100}).converged);
    EXPECT_LT((x[0] - Vec3::Ones()).norm(), 1e-8);
}

TEST(Lbfgs, GivesUpWhenNoStepAlongTheDirectionLowersTheValue)
{
    Wall objective(1);
    std::vector<Vec3> x{Vec3(1, 2, 2)};
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-9, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_EQ(x[0], Vec3(1, 2, 2));
    EXPECT_EQ(outcome.value, 4.5);
    EXPECT_LT(objective.evaluated, 20);
}

TEST(Lbfgs, TriesThePlainDirectionBeforeItGivesUp)
{
    // The second iteration fails with the pair of the first, discards it, fails again, and ends.
    Wall objective(2);
    std::vector<Vec3> x{Vec3(1, 2, 2)};
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-9, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 1);
    EXPECT_EQ(x[0], Vec3(0.9, 1.8, 1.8)) << "where the first iteration ended";
    EXPECT_EQ(outcome.value, 0.5 * x[0].squaredNorm());
    EXPECT_GT(objective.evaluated, 20) << "two searches";
    EXPECT_LT(objective.evaluated, 40);
}

TEST(Lbfgs, GivesUpAtANonFiniteGradient)
{
    /// Finite value with a non-finite gradient: no direction leads down.
    class Broken : public Counting {
    public:
        double evaluate(View<const Vec3>, View<Vec3> gradient) override
        {
            gradient[0] = Vec3(kNaN, 0.0, 0.0);
            return 1.0;
        }
    };
    Broken objective;
    std::vector<Vec3> x{Vec3(1, 2, 2)};
    Lbfgs lbfgs;
    const Lbfgs::Outcome outcome = lbfgs.minimise(objective, x, {1e-9, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_EQ(x[0], Vec3(1, 2, 2));
}

TEST(Lbfgs, ForgetsItsHistoryInEveryCall)
{
    // The history of one problem must not affect the next, of another size or not.
    Valley valley;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)};
    Lbfgs used, fresh;
    (void)used.minimise(valley, x, {1e-10, 20});
    Quadratic quadratic;
    std::vector<Vec3> a = random_field(100, 2), b = a;
    (void)used.minimise(quadratic, a, {1e-10, 50});
    (void)fresh.minimise(quadratic, b, {1e-10, 50});
    EXPECT_EQ(a, b);
}

} // namespace
} // namespace toile::test
