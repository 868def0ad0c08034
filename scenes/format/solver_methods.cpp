#include "scenes/format/solver_methods.h"

namespace toile::scene {

bool is_baseline(SolverMethod method)
{
    return method != SolverMethod::Auto && method != SolverMethod::Direct &&
           method != SolverMethod::Quadrature;
}

bool runs_on_gpu(SolverMethod method)
{
    return method == SolverMethod::Auto || method == SolverMethod::Quadrature ||
           method == SolverMethod::Chebyshev || method == SolverMethod::AJacobi;
}

bool replaces_minimiser(SolverMethod method)
{
    return method == SolverMethod::Xpbd || method == SolverMethod::Vbd;
}

} // namespace toile::scene
