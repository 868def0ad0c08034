#include <cmath>

#include "core/linear/field.h"
#include "core/pd/minimiser/make_outer_loop.h"
#include "core/pd/step/step_objective.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/paper/figures.h"
#include "research/benchmarks/paper/half_edges.h"
#include "research/benchmarks/solvers/methods.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/subspace_solver.h"

namespace toile::research::paper {

namespace {

using solvers::Problem;
using solvers::SampledStep;

const std::vector<int> kIterations{1, 2, 4, 8, 16, 32};
constexpr int kSampledStep = 16;
constexpr double kStep = 1.0 / 120.0; ///< [s]
constexpr int kHistory = 5;           ///< pairs of L-BFGS

std::unique_ptr<GlobalSolver> paper_rule(const Problem& problem, Denominator denominator)
{
    PaperRule::Settings settings;
    settings.denominator = denominator;
    settings.voxels = half_edges_along(problem.start.positions, problem.start.triangles);
    return make_paper_rule(problem, settings);
}

struct Method {
    const char* name;
    std::unique_ptr<GlobalSolver> (*make)(const Problem&);
};
const Method kMethods[] = {
    {"direct",
     [](const Problem&) -> std::unique_ptr<GlobalSolver> { return std::make_unique<DirectSolver>(); }},
    {"quadrature (Toile)", &solvers::make_quadrature},
    {"Chebyshev",
     [](const Problem&) -> std::unique_ptr<GlobalSolver> { return std::make_unique<ChebyshevSolver>(); }},
    {"A-Jacobi",
     [](const Problem&) -> std::unique_ptr<GlobalSolver> { return std::make_unique<AggregatedJacobi>(); }},
    {"subspace",
     [](const Problem&) -> std::unique_ptr<GlobalSolver> { return std::make_unique<SubspaceSolver>(); }},
    {"paper", [](const Problem& problem) { return paper_rule(problem, Denominator::SameRule); }},
    {"paper, exact denominators",
     [](const Problem& problem) { return paper_rule(problem, Denominator::Exact); }}};

/// Local/global iterations with full steps.
void iterate(StepObjective& objective, int iterations, std::vector<Vec3>& x)
{
    std::vector<Vec3> gradient(x.size()), z(x.size());
    for (int iteration = 0; iteration < iterations; ++iteration) {
        objective.evaluate(x, gradient);
        objective.precondition(gradient, z);
        axpy(-1.0, z, x);
    }
}

/// Curves of all loops around the system's solver.
void add_curves(const Problem& problem, const System& system, const SampledStep& step, Curve curve,
                double seconds, std::vector<Curve>& curves)
{
    StepObjective objective(system, step_start(problem, system, step), nullptr);
    std::vector<Vec3> x, gradient(step.x.size());
    objective.evaluate(step.prediction, gradient);
    const double start_gradient = std::sqrt(dot(gradient, gradient));
    const auto distance = [&](const std::vector<Vec3>& from) {
        std::vector<Vec3> e = from;
        axpy(-1.0, step.minimiser, e);
        return std::sqrt(dot(e, e));
    };
    const auto add = [&](const char* loop, const std::function<int(int)>& run) {
        curve.loop = loop;
        curve.points.clear();
        trace(
            curve, kIterations, seconds,
            [&](int iterations) {
                x = step.prediction;
                return run(iterations);
            },
            [&](Curve::Point& point) {
                objective.evaluate(x, gradient);
                point.residual = std::sqrt(dot(gradient, gradient)) / start_gradient;
                point.error = distance(x) / distance(step.prediction);
            });
        curves.push_back(curve);
    };
    add("plain", [&](int iterations) {
        iterate(objective, iterations, x);
        return iterations;
    });
    for (const auto& [method, loop] :
         {std::pair(OuterMethod::LocalGlobal, "line search"), std::pair(OuterMethod::Lbfgs, "l-bfgs")})
        add(loop, [&, method = method](int iterations) {
            return make_outer_loop(method, kHistory)->minimise(objective, x, {0.0, iterations}).iterations;
        });
}

} // namespace

std::vector<Curve> step_curves(const Effort& effort)
{
    std::vector<Curve> curves;
    for (const Problem& problem :
         {Problem::bar(effort.vertices, 2e5, kStep), Problem::drape(effort.vertices, 1e3, kStep)}) {
        const SampledStep step = solvers::sample_steps(problem, 1, kSampledStep).front();
        for (const Method& method : kMethods) {
            const std::unique_ptr<System> system = problem.make_system(method.make(problem));
            Curve curve;
            curve.figure = 12;
            curve.problem = problem.mesh + " " + std::to_string(problem.vertex_count());
            curve.method = method.name;
            curve.setup_ms = best_ms(0.0, [&] { system->prepare(problem.dt, problem.fixed); });
            add_curves(problem, *system, step, curve, effort.seconds, curves);
        }
    }
    return curves;
}

} // namespace toile::research::paper
