#include "research/benchmarks/solvers/methods.h"

#include "core/pd/step/body.h"
#include "core/pd/step/step_objective.h"
#include "core/quadrature/quadrature_solver.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/jacobi_pcg.h"
#include "research/linear/multigrid.h"
#include "research/linear/subspace_solver.h"
#include "research/methods/jgs2/jgs2.h"
#include "research/methods/vbd/vertex_block_descent.h"
#include "research/methods/xpbd/xpbd.h"
#include "scenes/method/solver_choice.h"

namespace toile::research::solvers {

namespace {

constexpr int kAnySize = 1'000'000;

/// Maximum of vertices times outer iterations for Jacobi-PCG, whose inner iterations grow with the mesh as
/// well: beyond it one step takes seconds.
constexpr int kJacobiPcgSize = 130'000;

/// Maximum number of vertices for JGS2, whose subspaces are dense.
constexpr int kJgs2Size = 1300;

/// Stepper around a Body, BaselineMethod or any class with the interface of Body.
template <typename Simulated>
class StepperOf : public Stepper {
public:
    template <typename Step>
    StepperOf(const Problem& problem, std::unique_ptr<Simulated> simulated, const Step& step)
        : acceleration_(problem.acceleration()), simulated_(std::move(simulated)), step_(step)
    {
    }
    int step(const SampledStep& from) override
    {
        simulated_->set_positions(from.x);
        simulated_->set_velocities(from.v);
        return step_(*simulated_, acceleration_).iterations;
    }
    View<const Vec3> positions() const override { return simulated_->positions(); }

private:
    std::vector<Vec3> acceleration_;
    std::unique_ptr<Simulated> simulated_;
    std::function<StepReport(Simulated&, const std::vector<Vec3>&)> step_;
};

using MakeSolver = std::function<std::unique_ptr<GlobalSolver>(const Problem&)>;

template <typename Solver>
std::unique_ptr<GlobalSolver> make_plain(const Problem&)
{
    return std::make_unique<Solver>();
}

Method make_method(const std::string& name, const MakeSolver& make, int iterations,
                   OuterMethod outer = OuterMethod::Lbfgs)
{
    return {name + " " + std::to_string(iterations),
            kAnySize,
            false,
            true,
            name.starts_with("quadrature"),
            [=](const Problem& problem) {
                Body::Settings settings;
                settings.tolerance = 0.0;
                settings.max_iterations = iterations;
                settings.outer = outer;
                auto body = std::make_unique<Body>(problem.start.positions,
                                                   problem.make_system(make(problem)), settings);
                return std::make_unique<StepperOf<Body>>(
                    problem, std::move(body), [&problem](Body& b, const std::vector<Vec3>& acceleration) {
                        return b.step(problem.dt, acceleration, problem.fixed, problem.start.positions,
                                      nullptr, nullptr);
                    });
            }};
}

/// Stepper around JGS2, which needs no global solver.
class Jgs2Stepper : public Stepper {
public:
    Jgs2Stepper(const Problem& problem, int iterations)
        : problem_(problem), system_(problem.make_system(std::make_unique<JacobiPcg>())),
          jgs2_(problem.start.positions), iterations_(iterations)
    {
        system_->prepare(problem.dt, problem.fixed);
    }
    int step(const SampledStep& from) override
    {
        StepObjective objective(*system_, step_start(problem_, *system_, from), nullptr);
        x_ = from.prediction;
        return jgs2_.minimise(objective, x_, {0.0, iterations_}).iterations;
    }
    View<const Vec3> positions() const override { return x_; }

private:
    const Problem& problem_;
    std::unique_ptr<System> system_;
    Jgs2 jgs2_;
    int iterations_;
    std::vector<Vec3> x_;
};

template <typename Rule>
Method baseline(const std::string& name, const typename Rule::Settings& settings)
{
    return {name, kAnySize, false, false, false, [=](const Problem& problem) {
                return std::make_unique<StepperOf<BaselineMethod>>(
                    problem, std::make_unique<Rule>(problem.start.positions, problem.cloth, settings),
                    [&problem](BaselineMethod& r, const std::vector<Vec3>& acceleration) {
                        return r.step(problem.dt, acceleration, problem.fixed, problem.start.positions);
                    });
            }};
}

} // namespace

std::unique_ptr<GlobalSolver> make_quadrature(const Problem& problem)
{
    return std::make_unique<QuadratureSolver>(
        problem.points(), problem.solid ? scenes::kTablesOfVolumes : QuadratureSolver::Settings{},
        problem.tables);
}

std::unique_ptr<GlobalSolver> make_paper_rule(const Problem& problem, PaperRule::Settings settings)
{
    if (problem.solid)
        return std::make_unique<PaperRule>(problem.start.positions, problem.solid->rest->tets, settings);
    return std::make_unique<PaperRule>(problem.chart(), problem.start.triangles, settings);
}

bool applies(const Method& method, const Problem& problem)
{
    return problem.vertex_count() <= method.max_vertices &&
           (problem.is_flat || problem.solid || !method.needs_chart) &&
           (method.knows_energies || !(problem.ball || problem.solid));
}

std::vector<Method> all_methods()
{
    std::vector<Method> methods;
    // One iteration may be enough where XPBD has converged.
    methods.push_back(make_method("direct", make_plain<DirectSolver>, 1));
    methods.push_back(make_method("quadrature", make_quadrature, 1));
    for (const int iterations : {3, 8, 20, 50}) {
        methods.push_back(make_method("direct", make_plain<DirectSolver>, iterations));
        methods.push_back(
            make_method("direct lg", make_plain<DirectSolver>, iterations, OuterMethod::LocalGlobal));
        methods.push_back(
            make_method("direct anderson", make_plain<DirectSolver>, iterations, OuterMethod::Anderson));
        methods.push_back(make_method("quadrature", make_quadrature, iterations));
        methods.push_back(make_method("multigrid", make_plain<Multigrid>, iterations));
        methods.push_back(make_method("subspace", make_plain<SubspaceSolver>, iterations));
        methods.push_back(make_method("chebyshev", make_plain<ChebyshevSolver>, iterations));
        methods.push_back(make_method("a-jacobi", make_plain<AggregatedJacobi>, iterations));
        methods.push_back(make_method("jacobi-pcg", make_plain<JacobiPcg>, iterations));
        methods.back().max_vertices = iterations > 8 ? kJacobiPcgSize / iterations : kAnySize;
        methods.push_back(make_method(
            "paper", [](const Problem& problem) { return make_paper_rule(problem); }, iterations));
        methods.back().max_vertices = kPaperSize;
        methods.back().needs_chart = true;
    }
    for (const int iterations : {1, 2, 4, 8}) {
        methods.push_back(
            make_method("direct newton-pcg", make_plain<DirectSolver>, iterations, OuterMethod::NewtonPcg));
        methods.push_back(
            make_method("quadrature newton-pcg", make_quadrature, iterations, OuterMethod::NewtonPcg));
    }
    for (const int iterations : {1, 2, 4, 8}) {
        methods.push_back(
            {"jgs2 " + std::to_string(iterations), kJgs2Size, false, true, false,
             [=](const Problem& problem) { return std::make_unique<Jgs2Stepper>(problem, iterations); }});
    }
    for (const int sweeps : {10, 50, 200}) {
        VertexBlockDescent::Settings settings;
        settings.max_sweeps = sweeps;
        methods.push_back(baseline<VertexBlockDescent>("vbd " + std::to_string(sweeps), settings));
    }
    for (const int substeps : {5, 20, 80}) {
        Xpbd::Settings settings;
        settings.substeps = substeps;
        methods.push_back(baseline<Xpbd>("xpbd " + std::to_string(substeps), settings));
    }
    return methods;
}

} // namespace toile::research::solvers
