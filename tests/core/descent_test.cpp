#include <limits>

#include <gtest/gtest.h>

#include "core/pd/lbfgs.h"
#include "tests/core/descent_arrays.h"
#include "tests/core/objectives.h"

/// The descent of a GPU, its kernels called one by one on the CPU, against the CPU's own loop. No GPU is
/// needed.
namespace toile::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class DescentOnHost {
public:
    explicit DescentOnHost(int n) : arrays_(n) {}

    void hold(int vertex) { arrays_.fixed[vertex] = 1; }

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
        : x(start), x_there(start)
    {
        Lbfgs lbfgs(kHistory);
        here = lbfgs.minimise(objective, x, settings);
        there = DescentOnHost(int(start.size())).minimise(objective, x_there, settings);
    }

    std::vector<Vec3> x, x_there;
    OuterLoop::Outcome here;
    Descent there;
};

TEST(Descent, TakesTheStepsOfTheTwoLoopRecursion)
{
    // Pairs are kept in single precision, so steps differ in the eighth digit and then more.
    Unsymmetric objective;
    for (const int iterations : {1, 2, 3, 6, 12}) {
        const Both both(objective, random_field(100, 3), {0.0, iterations});
        EXPECT_EQ(both.there.iterations, iterations);
        EXPECT_FALSE(both.there.converged);
        EXPECT_LT(farthest(both.x_there, both.x), 1e-5) << iterations;
        EXPECT_NEAR(both.there.displacement, both.here.displacement, 1e-3 * both.here.displacement);
        EXPECT_NEAR(both.there.search.value, both.here.value, 1e-4 * both.here.value);
    }
}

TEST(Descent, SolvesAQuadraticInOneIterationWithTheExactInverse)
{
    Quadratic objective;
    const Both both(objective, random_field(100, 2), {1e-5, 50});
    EXPECT_TRUE(both.there.converged);
    EXPECT_EQ(both.there.iterations, both.here.iterations);
    EXPECT_LT(farthest(both.x_there, objective.center), 1e-10) << "the last move is made";
}

TEST(Descent, FollowsACurvedValleyToItsEnd)
{
    Valley objective;
    const Both both(objective, {Vec3(-1.2, 1.0, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.3, 1.5, 2.0)},
                    {1e-10, 1000});
    EXPECT_TRUE(both.there.converged);
    EXPECT_LT(both.there.iterations, 2 * both.here.iterations);
    EXPECT_LT(farthest(both.x_there, std::vector<Vec3>(3, Vec3::Ones())), 1e-7);
}

TEST(Descent, StopsAtTheIterationLimit)
{
    Unsymmetric objective;
    const std::vector<Vec3> start = random_field(100, 4);
    const Both none(objective, start, {1e-9, 0});
    EXPECT_EQ(none.x_there, start);
    EXPECT_EQ(none.there.turns, 1);
    const Both seven(objective, start, {1e-9, 7});
    EXPECT_FALSE(seven.there.converged);
    EXPECT_EQ(seven.there.turns, 8) << "the start and seven trials";
}

TEST(Descent, GivesUpWhereNoStepLowersTheValue)
{
    for (const int open : {1, 2}) {
        Wall here(open), there(open);
        std::vector<Vec3> x{Vec3(1, 2, 2)}, x_there = x;
        Lbfgs lbfgs;
        const OuterLoop::Outcome expected = lbfgs.minimise(here, x, {1e-9, 50});
        const Descent found = DescentOnHost(1).minimise(there, x_there, {1e-9, 50});
        EXPECT_FALSE(found.converged);
        EXPECT_EQ(found.iterations, expected.iterations);
        EXPECT_EQ(there.evaluated, here.evaluated);
        EXPECT_LT(farthest(x_there, x), 1e-7);
        EXPECT_NEAR(found.search.value, expected.value, 1e-6);
    }
}

TEST(Descent, LeavesAloneWhatIsNotFinite)
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

TEST(Descent, LeavesFixedVerticesWhereTheyAreWhateverPullsAtThem)
{
    /// The quadratic with an inverse that knows every third vertex to be fixed, as quadrature's does; the
    /// gradient there is zero where `holds` says so.
    class Held : public Unsymmetric {
    public:
        explicit Held(bool holds) : holds_(holds) {}
        double evaluate(View<const Vec3> x, View<Vec3> gradient) override
        {
            const double value = Unsymmetric::evaluate(x, gradient);
            if (holds_)
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
        bool holds_;
    };
    const std::vector<Vec3> start = random_field(100, 6);
    std::vector<Vec3> x = start, x_there = start;
    Held here(true);
    Lbfgs lbfgs(kHistory);
    ASSERT_TRUE(lbfgs.minimise(here, x, {1e-7, 500}).converged);

    Held objective(false); // the descent itself must not listen to them
    DescentOnHost there(100);
    for (int i = 0; i < 100; i += 3)
        there.hold(i);
    EXPECT_TRUE(there.minimise(objective, x_there, {1e-7, 500}).converged);
    for (int i = 0; i < 100; i += 3)
        EXPECT_EQ(x_there[i], start[i]);
    EXPECT_LT(farthest(x_there, x), 1e-5);
}

} // namespace
} // namespace toile::test
