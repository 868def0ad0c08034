#include "research/scenes/literature_methods.h"

#include "core/base/assert.h"
#include "core/base/error.h"
#include "research/linear/aggregated_jacobi.h"
#include "research/linear/chebyshev_solver.h"
#include "research/linear/cuda/aggregated_jacobi.h"
#include "research/linear/cuda/chebyshev_solver.h"
#include "research/linear/jacobi_pcg.h"
#include "research/linear/multigrid.h"
#include "research/linear/subspace_solver.h"
#include "research/methods/vbd/vertex_block_descent.h"
#include "research/methods/xpbd/xpbd.h"
#include "research/paper_rule/flat_chart.h"
#include "research/paper_rule/paper_rule.h"

namespace toile::research {

using scene::SolverMethod;

namespace {

/// Chebyshev acceleration of vertex block descent [-], from kLongSolve sweeps per step. Measurements: it
/// accelerates long solves and degrades short ones (docs/theory/baselines.md).
constexpr double kRho = 0.95;
constexpr int kLongSolve = 20;

/// Sweeps or substeps of a step, unless the scene says otherwise.
constexpr int kPasses = 30;

std::unique_ptr<GlobalSolver> make_paper_rule(const TriangleMesh& start, const std::string& source)
{
    const auto chart = flat_chart(start);
    if (!chart)
        throw InvalidInput(source +
                           ": its rest shape is not flat, and solver.method \"paper\" needs a flat " +
                           "one; choose \"auto\", \"direct\" or another");
    return std::make_unique<PaperRule>(*chart, start.triangles);
}

std::unique_ptr<PointMasses> make_xpbd(const scene::Solver& solver, std::vector<Vec3> positions,
                                       garment::ClothModel cloth)
{
    Xpbd::Settings settings;
    settings.substeps = solver.max_iterations.value_or(kPasses);
    return std::make_unique<Xpbd>(std::move(positions), std::move(cloth), settings);
}

std::unique_ptr<PointMasses> make_vbd(const scene::Solver& solver, std::vector<Vec3> positions,
                                      garment::ClothModel cloth)
{
    VertexBlockDescent::Settings settings;
    settings.max_sweeps = solver.max_iterations.value_or(kPasses);

    // The adaptive start never releases cloth that contact supports. A vertex that has not moved starts from
    // its current position, and a few sweeps over stiff cloth don't move it.
    settings.start = VertexBlockDescent::Start::Prediction;
    settings.rho = settings.max_sweeps < kLongSolve ? 0.0 : kRho;
    return std::make_unique<VertexBlockDescent>(std::move(positions), std::move(cloth), settings);
}

} // namespace

std::unique_ptr<GlobalSolver> LiteratureMethods::make_global_solver(SolverMethod method,
                                                                    const TriangleMesh& start,
                                                                    const std::string& source) const
{
    switch (method) {
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
    default:
        throw InvalidInput(source + ": its solver.method is no baseline's global solver");
    }
}

std::unique_ptr<DeviceSolver> LiteratureMethods::make_device_solver(SolverMethod method,
                                                                    const CudaSpace& space) const
{
    if (method == SolverMethod::Chebyshev)
        return std::make_unique<DeviceChebyshevSolver>(space);
    TOILE_ASSERT(method == SolverMethod::AJacobi);
    return std::make_unique<DeviceAggregatedJacobi>(space);
}

std::unique_ptr<PointMasses> LiteratureMethods::make_body(const scene::Solver& solver,
                                                          std::vector<Vec3> positions,
                                                          garment::ClothModel cloth) const
{
    return solver.method == SolverMethod::Xpbd ? make_xpbd(solver, std::move(positions), std::move(cloth))
                                               : make_vbd(solver, std::move(positions), std::move(cloth));
}

} // namespace toile::research
