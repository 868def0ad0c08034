#include "research/benchmarks/gpu/contenders.h"

#include <initializer_list>
#include <utility>

#include "core/pd/cuda/body.h"
#include "core/quadrature/cuda/quadrature_solver.h"
#include "research/benchmarks/solvers/methods.h"
#include "research/linear/cuda/aggregated_jacobi.h"
#include "research/linear/cuda/chebyshev_solver.h"
#include "research/methods/vbd/cuda/vertex_block_descent.h"
#include "research/methods/xpbd/cuda/xpbd.h"
#include "research/paper_rule/cuda/paper_rule.h"

namespace toile::research::gpu {

namespace {

Contender contender(std::unique_ptr<PointMasses> masses)
{
    PointMasses* const placed = masses.get();
    return {std::move(masses), [placed](const Sample& sample) {
                placed->set_positions(sample.step.x);
                placed->set_velocities(sample.step.v);
            }};
}

std::unique_ptr<PointMasses> make_body(const CudaSpace& space, const solvers::Problem& problem,
                                       std::unique_ptr<GlobalSolver> solver, double tolerance,
                                       int max_iterations)
{
    DeviceBody::Settings settings;
    settings.tolerance = tolerance;
    settings.max_iterations = max_iterations;
    return std::make_unique<DeviceBody>(space, problem.start.positions,
                                        problem.make_system(std::move(solver)), settings);
}

std::unique_ptr<GlobalSolver> make_quadrature(const CudaSpace& space, const solvers::Problem& problem)
{
    return std::make_unique<DeviceQuadratureSolver>(
        space, std::vector<DeviceQuadratureSolver::Part>{{problem.points(), {}}}, problem.tables);
}

template <typename Solver>
std::unique_ptr<GlobalSolver> make_plain(const CudaSpace& space, const solvers::Problem&)
{
    return std::make_unique<Solver>(space);
}

/// @param applications  of the rule per iteration
NamedSolver paper_rule(const std::string& name, Denominator denominator, int applications)
{
    return {name, [=](const CudaSpace& space, const solvers::Problem& problem) {
                DevicePaperRule::Settings settings;
                settings.denominator = denominator;
                settings.applications = applications;
                return std::make_unique<DevicePaperRule>(space, problem.chart(), problem.start.triangles,
                                                         settings);
            }};
}

DeviceMethod make_method(const NamedSolver& solver, int iterations)
{
    return {solver.name + " " + std::to_string(iterations), 1,
            [=](const CudaSpace& space, const solvers::Problem& problem) {
                return contender(make_body(space, problem, solver.make(space, problem), 0.0, iterations));
            }};
}

template <typename T>
DeviceMethod xpbd(const std::string& name, int substeps)
{
    return {name + " " + std::to_string(substeps), 1,
            [substeps](const CudaSpace& space, const solvers::Problem& problem) {
                return contender(std::make_unique<DeviceXpbd<T>>(space, problem.start.positions,
                                                                 problem.cloth,
                                                                 typename DeviceXpbd<T>::Settings{substeps}));
            }};
}

template <typename T>
DeviceMethod vbd(const std::string& name, const typename DeviceVertexBlockDescent<T>::Settings& settings,
                 int parts = 1)
{
    return {name + " " + std::to_string(parts > 1 ? parts : settings.max_sweeps), parts,
            [settings](const CudaSpace& space, const solvers::Problem& problem) {
                auto descent = std::make_unique<DeviceVertexBlockDescent<T>>(space, problem.start.positions,
                                                                             problem.cloth, settings);
                auto* const placed = descent.get();
                Contender result = contender(std::move(descent));
                result.begin = [placed, begin = result.begin](const Sample& sample) {
                    begin(sample);
                    placed->set_last_velocities(sample.v_before);
                };
                return result;
            }};
}

/// Appends VBD with every number of sweeps that does not explode at once.
void append_vbd(std::vector<DeviceMethod>& methods)
{
    for (const bool lags : {false, true})
        for (const auto& [rho, suffix, min_sweeps] :
             {std::tuple{0.0, "", 10}, {0.98, " 0.98", 50}, {0.99, " 0.99", 100}})
            for (const int sweeps : {10, 50, 100, 200, 500, 1000, 2000})
                if (sweeps >= min_sweeps)
                    methods.push_back(vbd<float>(std::string(lags ? "vbd lagged" : "vbd") + suffix,
                                                 {sweeps, rho, true, lags}));
    for (const int sweeps : {50, 200})
        methods.push_back(vbd<double>("vbd double", {sweeps}));
}

DeviceMethod ours(const std::string& name, int iterations, int parts = 1)
{
    return {name + " " + std::to_string(parts > 1 ? parts : iterations), parts,
            [iterations](const CudaSpace& space, const solvers::Problem& problem) {
                return contender(make_ours(space, problem, 0.0, iterations));
            }};
}

/// Appends methods that split a sampled step into small steps, each with little work.
void append_small_steps(std::vector<DeviceMethod>& methods)
{
    for (const int parts : {4, 16, 32, 64}) {
        for (const int iterations : {1, 2, 5})
            methods.push_back(ours("quadrature of " + std::to_string(iterations), iterations, parts));
        for (const int sweeps : {1, 5})
            methods.push_back(vbd<float>("vbd of " + std::to_string(sweeps), {sweeps}, parts));
    }
}

} // namespace

std::unique_ptr<PointMasses> make_ours(const CudaSpace& space, const solvers::Problem& problem,
                                       double tolerance, int max_iterations)
{
    return make_body(space, problem, make_quadrature(space, problem), tolerance, max_iterations);
}

std::unique_ptr<PointMasses> make_xpbd(const CudaSpace& space, const solvers::Problem& problem, int substeps)
{
    return std::make_unique<DeviceXpbd<double>>(space, problem.start.positions, problem.cloth,
                                                DeviceXpbd<double>::Settings{substeps});
}

std::vector<NamedSolver> device_solvers(const solvers::Problem& problem)
{
    std::vector<NamedSolver> solvers{{"quadrature", make_quadrature},
                                     {"chebyshev", make_plain<DeviceChebyshevSolver>},
                                     {"a-jacobi", make_plain<DeviceAggregatedJacobi>}};
    if (problem.vertex_count() <= solvers::kPaperSize && problem.is_flat)
        for (const int applications : {1, 2}) {
            const std::string often = applications > 1 ? " twice" : "";
            solvers.push_back(paper_rule("paper" + often, Denominator::SameRule, applications));
            solvers.push_back(paper_rule("paper exact" + often, Denominator::Exact, applications));
        }
    return solvers;
}

std::vector<DeviceMethod> device_methods(const solvers::Problem& problem)
{
    std::vector<DeviceMethod> methods;
    for (const int iterations : {1, 2, 3, 5, 8, 20, 50, 100, 200, 500})
        methods.push_back(ours("quadrature", iterations));
    for (const NamedSolver& solver : device_solvers(problem))
        if (solver.name != "quadrature")
            for (const int iterations : {1, 3, 8, 20, 50, 200})
                methods.push_back(make_method(solver, iterations));
    append_vbd(methods);
    for (const int substeps : {5, 10, 20, 30, 40, 80, 160, 320, 640})
        methods.push_back(xpbd<float>("xpbd", substeps));
    for (const int substeps : {20, 320})
        methods.push_back(xpbd<double>("xpbd double", substeps));
    append_small_steps(methods);
    return methods;
}

} // namespace toile::research::gpu
