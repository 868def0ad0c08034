#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/linear/field.h"
#include "core/pd/minimiser/lbfgs.h"
#include "core/pd/minimiser/newton_direct.h"
#include "core/pd/minimiser/newton_pcg.h"
#include "core/pd/step/step_objective.h"
#include "research/benchmarks/solvers/methods.h"
#include "research/benchmarks/solvers/run.h"
#include "research/benchmarks/solvers/suite.h"

namespace toile::research::solvers {
namespace {

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double distance = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        distance = std::max(distance, (a[v] - b[v]).norm());
    return distance;
}

TEST(SolverReferences, ConvergeOnStiffClothAtLongSteps)
{
    // A problem on which L-BFGS alone stalls.
    const Problem problem = Problem::sheet(400, 1e4, 1.0 / 30.0);
    const std::vector<SampledStep> steps = sample_steps(problem, 2, 3);
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(problem.dt, problem.fixed);
    ASSERT_EQ(steps.size(), 2u);
    for (const SampledStep& step : steps) {
        EXPECT_TRUE(step.is_converged);
        StepObjective objective(*system, step_start(problem, *system, step), nullptr);
        std::vector<Vec3> gradient(step.x.size());
        EXPECT_NEAR(objective.evaluate(step.minimiser, gradient), step.energy, 1e-12 * step.start_energy);
        EXPECT_LT(max_norm(gradient), 1e-7) << "a vertex weighs " << 9.81 * problem.cloth.masses[0] << " N";
        EXPECT_LT(step.energy, step.start_energy);
    }
}

TEST(SolverReferences, AgreeWithAFactorOfTheWholeHessian)
{
    for (const Problem& problem :
         {Problem::sheet(200, 1e3, 1.0 / 120.0), Problem::drape(200, 1e2, 1.0 / 120.0)}) {
        SCOPED_TRACE(problem.mesh);
        const SampledStep step = sample_steps(problem, 1, 40).front();
        EXPECT_TRUE(step.is_converged);
        const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
        system->prepare(problem.dt, problem.fixed);
        StepObjective objective(*system, step_start(problem, *system, step), nullptr);
        std::vector<Vec3> x = step.prediction;
        (void)Lbfgs().minimise(objective, x, {0.0, 50});
        NewtonDirect direct;
        const double energy = direct.minimise(objective, x, {1e-10, 60}).value;
        EXPECT_LT(direct.decrement(), 1e-10 * (step.start_energy - energy));
        EXPECT_LT(max_distance(x, step.minimiser), 1e-5 * problem.mean_edge);
        EXPECT_NEAR(energy, step.energy, 1e-10 * (step.start_energy - energy));
    }
}

TEST(NewtonPcg, HasNoDecrementAfterTruncatedSolves)
{
    const Problem problem = Problem::sheet(200, 1e3, 1.0 / 120.0);
    const SampledStep step = sample_steps(problem, 1, 8).front();
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<DirectSolver>());
    system->prepare(problem.dt, problem.fixed);
    StepObjective objective(*system, step_start(problem, *system, step), nullptr);
    std::vector<Vec3> x = step.prediction;
    NewtonPcg cut(1);
    const OuterLoop::Outcome outcome = cut.minimise(objective, x, {0.0, 4});
    EXPECT_EQ(outcome.linear_iterations, outcome.iterations) << "one CG iteration each";
    EXPECT_TRUE(std::isinf(cut.decrement()));
}

TEST(SolverProblems, HaveConsistentDerivativesOfThePenaltyBall)
{
    BallPenalty ball({Vec3(0.1, 0.2, 0.3), 0.25, 5e4, 1e-3}, {1e-2, 2e-2, 1e-2});
    // Below the softness, above it, outside.
    const std::vector<Vec3> x{Vec3(0.1, 0.4495, 0.3), Vec3(0.2, 0.38, 0.4), Vec3(0.5, 0.5, 0.5)};
    BlockMatrix K(3, {});
    ball.add_curvature(x, Definiteness::Exact, K);
    std::vector<Vec3> gradient(3, Vec3::Zero());
    EXPECT_GT(ball.add_gradient(x, gradient), 0.0);
    EXPECT_TRUE(gradient[2].isZero());
    const double h = 1e-6;
    for (int v = 0; v < 2; ++v)
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec3> left = x, right = x, at_left(3, Vec3::Zero()), at_right(3, Vec3::Zero());
            left[v][k] -= h;
            right[v][k] += h;
            const double low = ball.add_gradient(left, at_left), high = ball.add_gradient(right, at_right);
            EXPECT_NEAR((high - low) / (2.0 * h), gradient[v][k], 1e-4);
            EXPECT_LT(((at_right[v] - at_left[v]) / (2.0 * h) - K.diagonal(v).col(k)).norm(), 0.05);
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

TEST(SolverTable, HasTheDocumentedColumnsAndFiniteRowsOfEveryMethod)
{
    const Problem problem = Problem::sheet(64, 1e3, 1.0 / 120.0);
    const std::vector<SampledStep> steps = sample_steps(problem, 1, 4);
    std::vector<Result> results;
    KeptTables kept;
    for (const Method& method : all_methods())
        results.push_back(run(problem, steps, method, 1, &kept));
    std::map<std::string, Result> by_name;
    for (const Result& r : results) {
        SCOPED_TRACE(r.method);
        by_name[r.method] = r;
        for (const double number :
             {r.setup_ms, r.step_ms, r.iterations, r.rms_over_edge, r.energy_gap, r.peak_mb})
            EXPECT_TRUE(std::isfinite(number));
        EXPECT_GT(r.step_ms, 0.0);
        EXPECT_GE(r.setup_ms, 0.0);
        EXPECT_GT(r.iterations, 0.0);
        EXPECT_EQ(r.vertices, 64);
    }
    EXPECT_EQ(by_name.size(), all_methods().size()) << "names are unique";
    for (const char* solver : {"direct", "quadrature", "multigrid", "subspace", "chebyshev", "a-jacobi",
                               "jacobi-pcg", "direct newton-pcg", "quadrature newton-pcg"}) {
        SCOPED_TRACE(solver);
        const std::string many = std::string(solver).ends_with("newton-pcg") ? " 8" : " 50";
        const std::string few = std::string(solver).ends_with("newton-pcg") ? " 1" : " 3";
        EXPECT_LT(by_name.at(solver + many).rms_over_edge, 0.5 * by_name.at(solver + few).rms_over_edge);
        EXPECT_LT(by_name.at(solver + many).energy_gap, 0.5 * by_name.at(solver + few).energy_gap);
    }

    const std::string csv = csv_table(results);
    EXPECT_EQ(csv.substr(0, csv.find(",gradients")),
              "mesh,vertices,stiffness,dt,method,threads,setup_ms,ms_per_step,iterations,rms_over_edge,"
              "energy_gap,peak_mb");
    EXPECT_EQ(size_t(std::count(csv.begin(), csv.end(), '\n')), results.size() + 1);
}

TEST(SolverTable, CountsKeptTablesForEveryMethodThatUsesThem)
{
    const Problem problem = Problem::sheet(400, 1e3, 1.0 / 120.0);
    const std::vector<SampledStep> steps = sample_steps(problem, 1, 1);
    KeptTables kept;
    for (const Method& method : choose_methods("quadrature 3"))
        (void)run(problem, steps, method, 1, &kept);
    ASSERT_TRUE(kept.owner);
    EXPECT_GT(kept.build_ms, 0.0);
    kept.build_ms = 1e6;
    for (const Method& method : choose_methods(" 3")) {
        const double setup_ms = run(problem, steps, method, 1, &kept).setup_ms;
        EXPECT_EQ(setup_ms >= 1e6, method.uses_tables) << method.name; // the rest may take no measurable time
    }
}

TEST(SolverSuite, ChoosesByMeshAndSizeAndRefusesUnknownNames)
{
    for (const Case& c : choose_cases("drape", true))
        EXPECT_EQ(c.problem.mesh, "drape");
    const std::vector<Case> one = choose_cases("skirt:300", false);
    ASSERT_EQ(one.size(), 1u);
    EXPECT_NEAR(one[0].problem.vertex_count(), 300, 60);
    EXPECT_EQ(choose_cases("", true).size(), 4u);

    for (const char* wrong : {"shirt", "sheet:", "sheet:ten", "sheet:10", "sheet:-900", "sheet:900x",
                              "sheet:99999999999", ":900", "Sheet"})
        EXPECT_THROW((void)choose_cases(wrong, false), InvalidInput) << wrong;
    try {
        (void)choose_cases("shirt", false);
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("sheet, skirt, drape or bar"), std::string::npos);
    }
    EXPECT_EQ(choose_methods("xpbd").size(), 3u);
    EXPECT_THROW((void)choose_methods("gauss"), InvalidInput);
}

TEST(SolverSuite, SkipsProblemsThatAMethodDoesNotSupport)
{
    const Problem drape = Problem::drape(100, 1e3, 1.0 / 120.0), skirt = Problem::skirt(200, 1e3, 1.0 / 60.0);
    const Problem bar = Problem::bar(100, 1e5, 1.0 / 120.0);
    for (const Method& method : choose_methods("xpbd"))
        EXPECT_FALSE(applies(method, drape) || applies(method, bar)) << "they know neither balls nor solids";
    for (const Method& method : choose_methods("paper")) {
        EXPECT_FALSE(applies(method, skirt)) << "no chart";
        EXPECT_TRUE(applies(method, bar));
    }
    for (const Method& method : choose_methods("direct"))
        EXPECT_TRUE(applies(method, drape) && applies(method, skirt));
}

} // namespace
} // namespace toile::research::solvers
