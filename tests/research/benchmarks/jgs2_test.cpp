#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/linear/field.h"
#include "core/pd/minimiser/local_global.h"
#include "core/pd/minimiser/newton_direct.h"
#include "core/pd/step/step_objective.h"
#include "research/benchmarks/solvers/problem.h"
#include "research/methods/jgs2/jgs2.h"
#include "tests/support/refusal.h"

namespace toile::research::solvers {
namespace {

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    std::vector<Vec3> difference = a;
    axpy(-1.0, b, difference);
    return std::sqrt(dot(difference, difference));
}

Problem small(const std::string& mesh)
{
    return mesh == "bar" ? Problem::bar(100, 1e5, 1.0 / 120.0) : Problem::sheet(100, 1e3, 1.0 / 120.0);
}

/// At rest, however turned, the first direction is Newton's: subspaces are exact, and turn with the body.
TEST(Jgs2, StepsLikeNewtonFromRest)
{
    for (const char* mesh : {"bar", "sheet"})
        for (const double angle : {0.0, 1.2}) {
            SCOPED_TRACE(std::string(mesh) + " turned by " + std::to_string(angle));
            Problem problem = small(mesh);
            std::fill(problem.fixed.begin(), problem.fixed.end(), 0);
            const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
            system->prepare(problem.dt, problem.fixed);
            SampledStep step;
            const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
            for (const Vec3& p : problem.start.positions) {
                step.x.push_back(turn * p);
                step.prediction.push_back(turn * (p + 1e-3 * Vec3(p.y() + p.z(), p.x() * p.x(), p.x())));
            }
            StepObjective objective(*system, step_start(problem, *system, step), nullptr);
            std::vector<Vec3> by_newton = step.x, by_jgs2 = step.x;
            (void)NewtonDirect().minimise(objective, by_newton, {0.0, 1});
            (void)Jgs2(problem.start.positions).minimise(objective, by_jgs2, {0.0, 1});
            EXPECT_GT(distance(by_newton, step.x), 1e-4);
            EXPECT_LT(distance(by_jgs2, by_newton), 1e-6 * distance(by_newton, step.x));
        }
}

TEST(Jgs2, ConvergesInFewerIterationsThanLocalGlobal)
{
    for (const char* mesh : {"bar", "sheet"}) {
        SCOPED_TRACE(mesh);
        const Problem problem = small(mesh);
        const SampledStep step = sample_steps(problem, 1, 16).front();
        const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
        system->prepare(problem.dt, problem.fixed);
        StepObjective objective(*system, step_start(problem, *system, step), nullptr);
        const auto error = [&](OuterLoop&& loop, int iterations) {
            std::vector<Vec3> x = step.prediction;
            (void)loop.minimise(objective, x, {0.0, iterations});
            return distance(x, step.minimiser) / distance(step.prediction, step.minimiser);
        };
        EXPECT_LT(error(Jgs2(problem.start.positions), 4), 0.25 * error(LocalGlobal(), 4));
        EXPECT_LT(error(Jgs2(problem.start.positions), 16), 1e-3);
    }
}

TEST(Jgs2, ServesOneStepLengthAndOneSetOfFixedVertices)
{
    const Problem problem = small("bar");
    const SampledStep step = sample_steps(problem, 1, 1).front();
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    Jgs2 jgs2(problem.start.positions);
    const auto refusal_of = [&](double dt, const std::vector<unsigned char>& fixed) {
        Problem other = problem;
        other.dt = dt;
        other.fixed = fixed;
        system->prepare(dt, fixed);
        StepObjective objective(*system, step_start(other, *system, step), nullptr);
        std::vector<Vec3> x = step.prediction;
        return test::refusal([&] { (void)jgs2.minimise(objective, x, {0.0, 1}); });
    };
    EXPECT_EQ(refusal_of(problem.dt, problem.fixed), "");
    EXPECT_NE(refusal_of(0.5 * problem.dt, problem.fixed).find("jgs2: vertex 0 has the inertia "),
              std::string::npos);
    std::vector<unsigned char> fixed = problem.fixed;
    fixed.back() = fixed.back() == 0 ? 1 : 0;
    EXPECT_NE(refusal_of(problem.dt, fixed).find("jgs2: vertex " + std::to_string(fixed.size() - 1)),
              std::string::npos);
    EXPECT_EQ(refusal_of(problem.dt, problem.fixed), "");
}

} // namespace
} // namespace toile::research::solvers
