#include "scenes/global_solver_choice.h"

#include "core/linear/baselines/aggregated_jacobi.h"
#include "core/linear/baselines/chebyshev_solver.h"
#include "core/linear/baselines/jacobi_pcg.h"
#include "core/linear/baselines/multigrid.h"
#include "core/linear/baselines/subspace_solver.h"
#include "core/linear/direct_solver.h"
#include "core/quadrature/quadrature_solver.h"
#include "quadrature2d/geodesic_places.h"

namespace toile {

std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method, const RestShape& rest,
                                                 const TableSource& tables)
{
    using scene::SolverMethod;
    switch (method) {
    case SolverMethod::Quadrature:
        return std::make_unique<QuadratureSolver>(
            geodesic_places(rest.vertex_count(), surface_metric(rest.triangles, rest.edges, rest.topology)),
            QuadratureSolver::Settings{}, tables.store, tables.listener);
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
    case SolverMethod::Auto:
    case SolverMethod::Direct:
        break;
    }
    return std::make_unique<DirectSolver>();
}

} // namespace toile
