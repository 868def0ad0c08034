#include <limits>

#include <gtest/gtest.h>

#include "core/pd/minimiser/lbfgs.h"
#include "tests/core/pd/descent_arrays.h"
#include "tests/core/pd/objectives.h"

/// Descent of a GPU: its kernels, run on the CPU and compared with the CPU's loop. No GPU is needed.
namespace toile::test {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class DescentOnHost {
public:
    explicit DescentOnHost(int n) : arrays_(n) {}

    void fix(int vertex) { arrays_.fixed[vertex] = 1; }

    /// Minimises from x, in place.
    Descent minimise(Objective& objective, std::vector<Vec3>& x, const OuterLoop::Settings& settings)
    {
        const int n = int(x.size());
        DescentArrays::Point& trial = arrays_.trial;
        trial.x = x;
        Descent& descent = arrays_.descent[0];
        descent.tolerance = settings.tolerance;
        descent.max_iterations = settings.max_iterations;
        descent.dt2 = 1e-30;
        descent.mass = descent.driving = 1e30;
        descent.begin();
        const DescentFields fields = arrays_.fields();
        while (!descent.is_over) {
            arrays_.energy.assign(n, 0.0);
            arrays_.energy[0] = objective.evaluate(trial.x, trial.gradient);
            objective.precondition(trial.gradient, trial.z);
            TrialSums sums;
            for (int i = 0; i < n; ++i)
                sums += MeasureTrial{fields}(i);
            DecideOnTrial{arrays_.descent}(sums);
            for (int i = 0; i < n; ++i)
                TakeTrial{fields}(i);
        }
        x = arrays_.here.x;
        return descent;
    }

private:
    DescentArrays arrays_;
};

/// Both loops from the same point.
struct Both {
    Both(Objective& objective, const std::vector<Vec3>& start, const OuterLoop::Settings& settings)
        : x(start), x_descent(start)
    {
        Lbfgs lbfgs(kHistory);
        reference = lbfgs.minimise(objective, x, settings);
        descent = DescentOnHost(int(start.size())).minimise(objective, x_descent, settings);
    }

    std::vector<Vec3> x, x_descent;
    OuterLoop::Outcome reference;
    Descent descent;
};

TEST(Descent, TakesTheStepsOfTheTwoLoopRecursion)
{
    // Pairs are stored in single precision: steps differ in the eighth digit first, then more.
    Unsymmetric objective;
    for (const int iterations : {1, 2, 3, 6, 12}) {
        const Both both(objective, random_field(100, 3), {0.0, iterations});
        EXPECT_EQ(both.descent.iterations, iterations);
        EXPECT_FALSE(both.descent.converged);
        EXPECT_LT(max_distance(both.x_descent, both.x), 1e-5) << iterations;
        EXPECT_NEAR(both.descent.displacement, both.reference.displacement,
                    1e-3 * both.reference.displacement);
        EXPECT_NEAR(both.descent.search.value, both.reference.value, 1e-4 * both.reference.value);
    }
}

TEST(Descent, SolvesAQuadraticInOneIterationWithTheExactInverse)
{
    Quadratic objective;
    const Both both(objective, random_field(100, 2), {1e-5, 50});
    EXPECT_TRUE(both.descent.converged);
    EXPECT_EQ(both.descent.iterations, both.reference.iterations);
    EXPECT_LT(max_distance(both.x_descent, objective.center), 1e-10) << "the last move is made";
}

TEST(Descent, FollowsACurvedValleyToItsEnd)
{
    Valley objective;
    const Both both(objective, {Vec3(-1.2, 1.0, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.3, 1.5, 2.0)},
                    {1e-10, 1000});
    EXPECT_TRUE(both.descent.converged);
    EXPECT_LT(both.descent.iterations, 2 * both.reference.iterations);
    EXPECT_LT(max_distance(both.x_descent, std::vector<Vec3>(3, Vec3::Ones())), 1e-7);
}

TEST(Descent, StopsAtTheIterationLimit)
{
    Unsymmetric objective;
    const std::vector<Vec3> start = random_field(100, 4);
    const Both none(objective, start, {1e-9, 0});
    EXPECT_EQ(none.x_descent, start);
    EXPECT_EQ(none.descent.evaluations, 1);
    const Both seven(objective, start, {1e-9, 7});
    EXPECT_FALSE(seven.descent.converged);
    EXPECT_EQ(seven.descent.evaluations, 8) << "the start and seven trials";
}

TEST(Descent, GivesUpWhenNoStepLowersTheValue)
{
    for (const int open : {1, 2}) {
        Wall for_reference(open), for_descent(open);
        std::vector<Vec3> x{Vec3(1, 2, 2)}, x_descent = x;
        Lbfgs lbfgs;
        const OuterLoop::Outcome expected = lbfgs.minimise(for_reference, x, {1e-9, 50});
        const Descent found = DescentOnHost(1).minimise(for_descent, x_descent, {1e-9, 50});
        EXPECT_FALSE(found.converged);
        EXPECT_EQ(found.iterations, expected.iterations);
        EXPECT_EQ(for_descent.evaluated, for_reference.evaluated);
        EXPECT_LT(max_distance(x_descent, x), 1e-7);
        EXPECT_NEAR(found.search.value, expected.value, 1e-6);
    }
}

TEST(Descent, LeavesANonFiniteStartUnchanged)
{
    Quadratic objective;
    std::vector<Vec3> x = random_field(100, 2);
    x[50].z() = kNaN;
    const Descent start = DescentOnHost(100).minimise(objective, x, {1e-10, 50});
    EXPECT_FALSE(start.converged);
    EXPECT_FALSE(std::isfinite(start.start_value));
    EXPECT_EQ(start.iterations, 0);

    class Broken : public Counting {
    public:
        double evaluate(View<const Vec3>, View<Vec3> gradient) override
        {
            gradient[0] = Vec3(kNaN, 0.0, 0.0);
            return 1.0;
        }
    };
    Broken broken;
    x = {Vec3(1, 2, 2)};
    const Descent outcome = DescentOnHost(1).minimise(broken, x, {1e-9, 50});
    EXPECT_FALSE(outcome.converged);
    EXPECT_EQ(outcome.iterations, 0);
    EXPECT_EQ(x[0], Vec3(1, 2, 2));
}

TEST(Descent, KeepsFixedVerticesUnderAnyForce)
{
    /// Quadratic whose inverse treats every third vertex as fixed, as quadrature's does. The gradient at
    /// those vertices is zero if `holds`.
    class WithFixed : public Unsymmetric {
    public:
        explicit WithFixed(bool holds) : clears_(holds) {}
        double evaluate(View<const Vec3> x, View<Vec3> gradient) override
        {
            const double value = Unsymmetric::evaluate(x, gradient);
            if (clears_)
                clear(gradient);
            return value;
        }
        void precondition(View<const Vec3> g, View<Vec3> z) override
        {
            std::vector<Vec3> of_free(g.begin(), g.end());
            clear(of_free);
            Unsymmetric::precondition(of_free, z);
            clear(z);
        }

    private:
        static void clear(View<Vec3> field)
        {
            for (int i = 0; i < field.size(); i += 3)
                field[i].setZero();
        }
        bool clears_;
    };
    const std::vector<Vec3> start = random_field(100, 6);
    std::vector<Vec3> x = start, x_descent = start;
    WithFixed reference(true);
    Lbfgs lbfgs(kHistory);
    ASSERT_TRUE(lbfgs.minimise(reference, x, {1e-7, 500}).converged);

    WithFixed objective(false); // the algorithm itself must ignore their gradients
    DescentOnHost descent(100);
    for (int i = 0; i < 100; i += 3)
        descent.fix(i);
    EXPECT_TRUE(descent.minimise(objective, x_descent, {1e-7, 500}).converged);
    for (int i = 0; i < 100; i += 3)
        EXPECT_EQ(x_descent[i], start[i]);
    EXPECT_LT(max_distance(x_descent, x), 1e-5);
}

} // namespace
} // namespace toile::test
