#include <cmath>

#include "core/linear/field.h"
#include "core/pd/minimiser/make_outer_loop.h"
#include "core/pd/newton/host_newton.h"
#include "core/pd/newton/newton.h"
#include "core/pd/step/step_objective.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/paper/figures.h"
#include "research/benchmarks/paper/half_edges.h"
#include "research/benchmarks/solvers/methods.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/jacobi_pcg.h"
#include "research/linear/subspace_solver.h"
#include "research/methods/jgs2/jgs2.h"

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

/// A step that is minimised again and again from its prediction.
class RepeatedStep {
public:
    RepeatedStep(const Problem& problem, const System& system, const SampledStep& step, double seconds)
        : problem_(problem), system_(system), step_(step), seconds_(seconds),
          start_(step_start(problem, system, step)), objective_(system, start_, nullptr),
          gradient_(step.x.size())
    {
        objective_.evaluate(step.prediction, gradient_);
        start_gradient_ = std::sqrt(dot(gradient_, gradient_));
    }

    /// Appends the curve of a loop.
    /// @param minimise  minimise(iterations): moves x() from the prediction, returns the iterations made
    void add(Curve curve, const char* loop, const std::function<int(int)>& minimise,
             std::vector<Curve>& curves)
    {
        curve.figure = 12;
        curve.problem = problem_.mesh + " " + std::to_string(problem_.vertex_count());
        curve.loop = loop;
        trace(
            curve, kIterations, seconds_,
            [&](int iterations) {
                x_ = step_.prediction;
                return minimise(iterations);
            },
            [&](Curve::Point& point) {
                objective_.evaluate(x_, gradient_);
                point.residual = std::sqrt(dot(gradient_, gradient_)) / start_gradient_;
                point.error = error_of(x_) / error_of(step_.prediction);
            });
        curves.push_back(std::move(curve));
    }

    /// Appends the curves of all loops around the system's solver.
    void add_loops(const Curve& curve, std::vector<Curve>& curves)
    {
        add(
            curve, "plain",
            [&](int iterations) {
                iterate(objective_, iterations, x_);
                return iterations;
            },
            curves);
        for (const auto& [method, loop] :
             {std::pair(OuterMethod::LocalGlobal, "line search"), std::pair(OuterMethod::Lbfgs, "l-bfgs")})
            add(
                curve, loop,
                [&, method = method](int iterations) {
                    return make_outer_loop(method, kHistory)
                        ->minimise(objective_, x_, {0.0, iterations})
                        .iterations;
                },
                curves);
    }

    /// Appends the curves of methods that replace the loop: JGS2, and Toile's Newton's method.
    void add_minimisers(std::vector<Curve>& curves)
    {
        Jgs2 jgs2(problem_.start.positions);
        Curve curve;
        curve.method = "JGS2";
        const auto iterate_once = [&] {
            x_ = step_.prediction;
            (void)jgs2.minimise(objective_, x_, {0.0, 1});
        };
        curve.setup_ms = best_ms(0.0, iterate_once); // the first call tabulates too
        curve.setup_ms -= best_ms(0.0, iterate_once);
        const auto by_jgs2 = [&](int iterations) {
            return jgs2.minimise(objective_, x_, {0.0, iterations}).iterations;
        };
        add(curve, "line search", by_jgs2, curves);

        HostNewton newton(problem_.points(), problem_.solid ? Extent::Volume : Extent::Surface,
                          ComponentWeights(system_.masses(), system_.curvature().blocks(),
                                           system_.curvature().isotropic()));
        std::vector<double> inertia;
        for (const double mass : system_.masses())
            inertia.push_back(mass / (problem_.dt * problem_.dt));
        const auto by_newton = [&](int iterations) {
            newton.set_problem({&objective_, x_, step_.x, step_.v, step_.prediction, inertia, system_.fixed(),
                                problem_.dt, nullptr});
            return Newton::minimise(newton, {0.0, iterations, problem_.dt, false}, {}, true).iterations;
        };
        curve.method = "Newton (Toile)";
        curve.setup_ms = 0.0;
        add(curve, "line search", by_newton, curves);
    }

private:
    double error_of(const std::vector<Vec3>& x) const
    {
        std::vector<Vec3> e = x;
        axpy(-1.0, step_.minimiser, e);
        return std::sqrt(dot(e, e));
    }

    const Problem& problem_;
    const System& system_;
    const SampledStep& step_;
    double seconds_; ///< of repetitions
    StepStart start_;
    StepObjective objective_;
    double start_gradient_ = 0.0; ///< [N]
    std::vector<Vec3> x_, gradient_;
};

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
            curve.method = method.name;
            curve.setup_ms = best_ms(0.0, [&] { system->prepare(problem.dt, problem.fixed); });
            RepeatedStep(problem, *system, step, effort.seconds).add_loops(curve, curves);
        }
        const std::unique_ptr<System> system = problem.make_system(std::make_unique<JacobiPcg>());
        system->prepare(problem.dt, problem.fixed);
        RepeatedStep(problem, *system, step, effort.seconds).add_minimisers(curves);
    }
    return curves;
}

} // namespace toile::research::paper
