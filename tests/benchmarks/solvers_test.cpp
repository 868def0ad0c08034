#include <gtest/gtest.h>

#include "benchmarks/solvers/methods.h"
#include "benchmarks/solvers/run.h"
#include "core/linear/field.h"

namespace toile::solvers {
namespace {

TEST(SolverReferences, ConvergeOnStiffClothAtLongSteps)
{
    // Where L-BFGS alone stalls.
    const Problem problem = Problem::sheet(400, 1e4, 1.0 / 30.0);
    const std::vector<SampledStep> steps = sample_steps(problem, 2, 3);
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(problem.dt, problem.fixed);
    ASSERT_EQ(steps.size(), 2u);
    for (const SampledStep& step : steps) {
        EXPECT_TRUE(step.is_converged);
        StepObjective objective(*system, step_start(problem, *system, step), nullptr, Pcg::Settings{});
        std::vector<Vec3> gradient(step.x.size());
        EXPECT_NEAR(objective.evaluate(step.minimiser, gradient), step.energy, 1e-12 * step.start_energy);
        EXPECT_LT(max_norm(gradient), 1e-7) << "a vertex weighs " << 9.81 * problem.cloth.masses[0] << " N";
        EXPECT_LT(step.energy, step.start_energy);
    }
}

TEST(SolverMethods, CountWorkAndFlagReferences)
{
    const Problem problem = Problem::sheet(100, 1e3, 1.0 / 120.0);
    std::vector<SampledStep> steps = sample_steps(problem, 1, 4);
    const auto result_of = [&](const std::string& name) {
        for (const Method& method : all_methods())
            if (method.name == name)
                return run(problem, steps, method, 1);
        ADD_FAILURE() << "no method " << name;
        return Result{};
    };
    const Result lbfgs = result_of("direct 8"), newton = result_of("direct newton-pcg 8");
    EXPECT_EQ(lbfgs.solves, lbfgs.iterations) << "one inverse an iteration";
    EXPECT_GE(lbfgs.gradients, lbfgs.iterations + 1.0);
    EXPECT_GT(newton.solves, newton.iterations) << "one inverse a CG iteration";
    EXPECT_LT(newton.rms_over_edge, 0.1 * lbfgs.rms_over_edge);
    EXPECT_NE(csv_table({lbfgs}).find(",converged"), std::string::npos);

    steps[0].is_converged = false;
    EXPECT_NE(csv_table({result_of("direct 8")}).find(",not converged"), std::string::npos);
}

} // namespace
} // namespace toile::solvers
