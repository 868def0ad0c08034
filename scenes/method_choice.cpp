#include "scenes/method_choice.h"

#include "core/backend/error.h"
#include "core/linear/baselines/aggregated_jacobi.h"
#include "core/linear/baselines/chebyshev_solver.h"
#include "core/linear/baselines/jacobi_pcg.h"
#include "core/linear/baselines/multigrid.h"
#include "core/linear/baselines/subspace_solver.h"
#include "core/linear/direct_solver.h"
#include "core/quadrature/auto_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "garment/rivals/vertex_block_descent.h"
#include "garment/rivals/xpbd.h"
#include "quadrature2d/geodesic_places.h"
#include "quadrature2d/paper/paper_rule.h"
#include "scenes/flat_chart.h"
#include "scenes/format/field.h"

namespace toile {

using scene::SolverMethod;

namespace {

/// Chebyshev acceleration of vertex block descent [-], from kLongSolve sweeps a step on. Measured: it helps
/// long solves and spoils short ones (docs/garment/rivals.md).
constexpr double kRho = 0.95;
constexpr int kLongSolve = 20;

/// The methods of a scene for which `holds`, quoted, for a message.
template <typename Condition>
std::string methods_that(const Condition& holds)
{
    std::string list;
    for (const auto& [word, method] : scene_format::Words<SolverMethod>::kAll)
        if (holds(method))
            list += (list.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    return list;
}

std::unique_ptr<GlobalSolver> make_paper_rule(const TriangleMesh& start, const std::string& source)
{
    const auto chart = flat_chart(start);
    if (!chart)
        throw InvalidInput(
            source + ": its rest shape is not flat, and solver.method \"paper\" needs a flat " +
            "one; choose " + methods_that([](SolverMethod method) { return method != SolverMethod::Paper; }));
    return std::make_unique<PaperRule>(*chart, start.triangles);
}

} // namespace

std::vector<Place> places_of(const RestShape& rest)
{
    return geodesic_places(rest.vertex_count(), surface_metric(rest.triangles, rest.edges, rest.topology));
}

std::unique_ptr<GlobalSolver> make_global_solver(SolverMethod method, std::shared_ptr<const RestShape> rest,
                                                 const TriangleMesh& start, const std::string& source,
                                                 const TableSource& tables)
{
    switch (method) {
    case SolverMethod::Quadrature:
        return std::make_unique<QuadratureSolver>(places_of(*rest), QuadratureSolver::Settings{},
                                                  tables.store, tables.listener);
    case SolverMethod::Multigrid:
        return std::make_unique<Multigrid>();
    case SolverMethod::Subspace:
        return std::make_unique<SubspaceSolver>();
    case SolverMethod::Chebyshev:
        return std::make_unique<ChebyshevSolver>();
    case SolverMethod::AJacobi:
        return std::make_unique<AggregatedJacobi>();
    case SolverMethod::JacobiPcg:
        return std::make_unique<JacobiPcg>();
    case SolverMethod::Paper:
        return make_paper_rule(start, source);
    case SolverMethod::Auto:
        return std::make_unique<AutoSolver>([rest = std::move(rest)] { return places_of(*rest); },
                                            tables.store, tables.listener.warn);
    default:
        return std::make_unique<DirectSolver>();
    }
}

bool is_rival(SolverMethod method) { return method == SolverMethod::Xpbd || method == SolverMethod::Vbd; }

std::unique_ptr<Rival> make_rival(const scene::Solver& solver, std::vector<Vec3> positions, ClothModel cloth)
{
    if (solver.method == SolverMethod::Xpbd) {
        Xpbd::Settings settings;
        settings.substeps = solver.max_iterations;
        return std::make_unique<Xpbd>(std::move(positions), std::move(cloth), settings);
    }
    VertexBlockDescent::Settings settings;
    settings.max_sweeps = solver.max_iterations;

    // The adaptive start never lets go of cloth that contact holds: what has not moved begins where it is,
    // and a few sweeps over stiff cloth don't move it.
    settings.start = VertexBlockDescent::Start::Prediction;
    settings.rho = settings.max_sweeps < kLongSolve ? 0.0 : kRho;
    return std::make_unique<VertexBlockDescent>(std::move(positions), std::move(cloth), settings);
}

void require_method_holds(SolverMethod method, const scene::Attachment& attachment, const std::string& place)
{
    if (attachment.stiffness && is_rival(method))
        throw InvalidInput(place + ".stiffness: solver.method \"" + scene_format::word_of(method) +
                           "\" knows no springs; remove the key to hold the vertices exactly, or choose " +
                           methods_that([](SolverMethod other) { return !is_rival(other); }));
}

} // namespace toile
