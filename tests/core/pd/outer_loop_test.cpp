#include <limits>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/pd/minimiser/make_outer_loop.h"
#include "core/pd/minimiser/recent_values.h"
#include "tests/core/pd/objectives.h"

/// Common behaviour of plain local/global and Anderson acceleration with L-BFGS (lbfgs_test.cpp), and their
/// differences.
namespace toile::test {

namespace {

class FirstOrder : public testing::TestWithParam<OuterMethod> {
protected:
    std::unique_ptr<OuterLoop> loop_ = make_outer_loop(GetParam(), 5);
};

TEST_P(FirstOrder, SolvesAQuadraticInOneIterationWithTheExactInverse)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    const OuterLoop::Outcome outcome = loop_->minimise(objective, x, {1e-10, 50});
    EXPECT_TRUE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 1);
    EXPECT_EQ(objective.evaluated, 2) << "the start and one trial";
    EXPECT_LT(max_distance(x, objective.center), 1e-12);
}

TEST_P(FirstOrder, NeverRaisesTheValue)
{
    Valley objective;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)}, ignored(1);
    const double start = objective.evaluate(x, ignored);
    double previous = start;
    for (int pass = 0; pass < 60; ++pass) {
        const OuterLoop::Outcome outcome = loop_->minimise(objective, x, {1e-14, 7});
        EXPECT_LE(outcome.value, previous * (1.0 + 1e-13));
        EXPECT_EQ(outcome.value, objective.evaluate(x, ignored)) << "the value belongs to x";
        previous = outcome.value;
    }
    EXPECT_LT(previous, 0.5 * start);
}

TEST_P(FirstOrder, StopsWhenIterationsGainTooLittle)
{
    struct Modest : Valley {
        double worth = 0.0;
        double negligible_gain(double) const override { return worth; }
    };
    const auto values_until = [&](double worth, int max_limit) {
        std::vector<double> values;
        std::vector<Vec3> ignored(1);
        for (int limit = 0; limit <= max_limit; ++limit) {
            Modest valley;
            valley.worth = worth;
            std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)};
            const OuterLoop::Outcome outcome = loop_->minimise(valley, x, {1e-14, limit});
            values.push_back(outcome.value);
            if (outcome.converged)
                break;
        }
        return values;
    };
    const std::vector<double> all = values_until(0.0, 40);
    ASSERT_EQ(all.size(), 41U) << "nothing is negligible";
    const double worth = 0.02 * all[0];
    size_t expected = RecentValues::kWindow;
    while (all[expected - RecentValues::kWindow] - all[expected] >= worth)
        ++expected;
    ASSERT_LT(expected, 40U);
    const std::vector<double> some = values_until(worth, 40);
    EXPECT_EQ(some.size(), expected + 1);
    EXPECT_EQ(some.back(), all[expected]);
}

TEST_P(FirstOrder, LeavesANonFiniteStartUnchanged)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    x[50].z() = std::numeric_limits<double>::quiet_NaN();
    const OuterLoop::Outcome outcome = loop_->minimise(objective, x, {1e-10, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_FALSE(std::isfinite(outcome.value));
}

TEST_P(FirstOrder, GivesUpWhenNoStepAlongTheDirectionLowersTheValue)
{
    Wall objective(2);
    std::vector<Vec3> x{Vec3(1, 2, 2)};
    const OuterLoop::Outcome outcome = loop_->minimise(objective, x, {1e-9, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 1);
    EXPECT_EQ(x[0], Vec3(0.9, 1.8, 1.8)) << "where the first iteration ended";
    EXPECT_LT(objective.evaluated, 40);
}

TEST_P(FirstOrder, ForgetsItsHistoryInEveryCall)
{
    Valley valley;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)};
    (void)loop_->minimise(valley, x, {1e-10, 20});
    Quadratic quadratic;
    std::vector<Vec3> a = random_field(100, 2), b = a;
    (void)loop_->minimise(quadratic, a, {1e-10, 50});
    (void)make_outer_loop(GetParam(), 5)->minimise(quadratic, b, {1e-10, 50});
    EXPECT_EQ(a, b);
}

INSTANTIATE_TEST_SUITE_P(OuterLoop, FirstOrder,
                         testing::Values(OuterMethod::LocalGlobal, OuterMethod::Anderson),
                         [](const auto& method) {
                             return method.param == OuterMethod::Anderson ? "Anderson" : "LocalGlobal";
                         });

/// Quadratic whose inverse is far too small, by different amounts along x, y and z: a model of the soft modes
/// of H.
class Soft : public Quadratic {
public:
    void precondition(View<const Vec3> g, View<Vec3> z) override
    {
        direct.solve(g, z);
        for (Vec3& value : z)
            value = value.cwiseProduct(Vec3(0.02, 0.1, 0.5));
    }
};

int iterations_on_soft(OuterMethod method)
{
    Soft objective;
    std::vector<Vec3> x = random_field(100, 2);
    const OuterLoop::Outcome outcome = make_outer_loop(method, 5)->minimise(objective, x, {1e-9, 5000});
    EXPECT_TRUE(outcome.converged);
    EXPECT_LT(max_distance(x, objective.center), 1e-6);
    return outcome.iterations;
}

TEST(Anderson, ConvergesInOneMovePerDistinctEigenvalue)
{
    // H^-1 A has three eigenvalues: three stored moves solve it, where a plain move reduces the error by
    // 1/50.
    EXPECT_GT(iterations_on_soft(OuterMethod::LocalGlobal), 300);
    EXPECT_LT(iterations_on_soft(OuterMethod::Anderson), 12);
}

TEST(Anderson, TakesThePlainMoveWhenTheAcceleratedOneRaisesTheValue)
{
    // In the valley acceleration overshoots; the safeguard costs an evaluation, never an inverse.
    class Counted : public Valley {
    public:
        void precondition(View<const Vec3> g, View<Vec3> z) override
        {
            ++preconditioned;
            z[0] = 1e-3 * g[0];
        }
        int preconditioned = 0;
    };
    Counted objective;
    std::vector<Vec3> x{Vec3(-1.2, 1.0, 1.0)};
    const OuterLoop::Outcome outcome =
        make_outer_loop(OuterMethod::Anderson, 5)->minimise(objective, x, {1e-12, 100});
    EXPECT_GT(objective.evaluated, outcome.iterations + 1) << "some accelerated moves were refused";
    EXPECT_LE(objective.preconditioned, outcome.iterations + 1);
}

TEST(NewtonPcg, RefusesAnObjectiveWithoutSecondDerivatives)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    EXPECT_THROW((void)make_outer_loop(OuterMethod::NewtonPcg, 5)->minimise(objective, x, {1e-10, 50}),
                 InvalidInput);
}

} // namespace
} // namespace toile::test
