#include "research/benchmarks/error_time/problems.h"

#include <utility>

#include "research/benchmarks/accuracy/scene_text.h"
#include "research/benchmarks/accuracy/statistics.h"

namespace toile::research::error_time {

using scene::SolverMethod;

namespace {

using accuracy::number;

/// Distance to the converged run after a quarter of a second, in edge lengths: the problem and the unit in
/// which other solvers have been measured too.
accuracy::Case hanging_sheet(int vertices_along_side)
{
    const double edge = 1.0 / (vertices_along_side - 1);
    accuracy::Case result;
    result.name =
        "sheet on two corners, " + std::to_string(vertices_along_side * vertices_along_side) + " vertices";
    result.quantity = "RMS distance after 0.25 s [edges]";
    result.scene = accuracy::scene_of(result.name, R"("fps": 120, "frames": 31, "air": {"density": 0},
        "contact": {"self": false}, "cloths": [{"name": "sheet", "fabric": "f",
            "rectangle": {"size": [1, 1], "resolution": )" +
                                                       number(edge) + R"(}}],
        "attachments": [{"cloth": "sheet", "select": {"nearest": [[-0.5, 0, -0.5], [0.5, 0, -0.5]]}}], )" +
                                                       accuracy::lossless_fabric(0.15, 1000.0, 5e-6));
    result.reference = accuracy::converged(result.scene, 8);
    result.measure = [edge](const accuracy::Trajectory& run, const accuracy::Trajectory* reference) {
        return accuracy::rms(run.last(), reference->last()) / edge;
    };
    result.aim = 1.0;
    return result;
}

struct NamedMethod {
    const char* name;
    SolverMethod method;
};
constexpr NamedMethod kGlobalSolvers[] = {
    {"direct", SolverMethod::Direct},       {"quadrature", SolverMethod::Quadrature},
    {"multigrid", SolverMethod::Multigrid}, {"subspace", SolverMethod::Subspace},
    {"Chebyshev", SolverMethod::Chebyshev}, {"A-Jacobi", SolverMethod::AJacobi},
    {"Jacobi-PCG", SolverMethod::JacobiPcg}};

} // namespace

std::vector<accuracy::Case> problems(bool quick)
{
    std::vector<accuracy::Case> result{hanging_sheet(50)};
    if (!quick)
        result.push_back(hanging_sheet(100));
    result.push_back(accuracy::hanging_skirt("99th percentile", 0.99));
    if (!quick)
        result.push_back(accuracy::pile());
    return result;
}

std::vector<Contender> contenders(bool quick)
{
    std::vector<Contender> result;
    const auto add = [&](const std::string& method, const std::string& setting, auto&& change) {
        Contender contender{method, setting, {}};
        change(contender.solver);
        result.push_back(std::move(contender));
    };
    for (const double error : {1e-3, 3e-4, 1e-4, 3e-5, 1e-5}) {
        add("Newton, BDF2", "step_error " + number(error), [&](scene::Solver& solver) {
            solver.step_error = error;
            if (error < 1e-4)
                solver.quality = scene::Quality::Final;
        });
        result.back().is_default = error == 1e-4;
    }
    for (const int substeps : {1, 2, 4, 8})
        add("preview", "substeps " + std::to_string(substeps), [&](scene::Solver& solver) {
            solver.quality = scene::Quality::Preview;
            solver.substeps = substeps;
        });
    if (quick)
        return result;
    for (const NamedMethod& named : kGlobalSolvers)
        for (const auto& [substeps, tolerance] : {std::pair{1, 0.12}, {1, 0.03}, {4, 0.03}, {16, 0.03}})
            add(named.name, "substeps " + std::to_string(substeps) + ", " + number(tolerance) + " m/s",
                [&, substeps = substeps, tolerance = tolerance](scene::Solver& solver) {
                    solver.method = named.method;
                    solver.outer = OuterMethod::Lbfgs;
                    solver.substeps = substeps;
                    solver.velocity_tolerance = tolerance;
                });
    for (const int passes : {10, 30, 100, 300})
        for (const NamedMethod& named : {NamedMethod{"XPBD", SolverMethod::Xpbd}, {"VBD", SolverMethod::Vbd}})
            add(named.name, std::to_string(passes) + " passes", [&](scene::Solver& solver) {
                solver.method = named.method;
                solver.substeps = 1;
                solver.max_iterations = passes;
            });
    return result;
}

} // namespace toile::research::error_time
