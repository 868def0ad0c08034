#include "research/linear/subspace_solver.h"

#include <algorithm>
#include <utility>

#include "research/linear/coarse_functions.h"

namespace toile::research {

namespace {

/// Ratio of the highest to the lowest smoothed eigenvalue, per vertex of a function [-]. It measured best at
/// 5k and 50k vertices, and flat within a factor of 2.
constexpr double kRatioPerVertex = 1.2;

/// Min ratio [-], for functions hardly wider than an edge.
constexpr double kMinRatio = 4.0;

} // namespace

void SubspaceSolver::prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal)
{
    SmootherSettings smoother;
    const double highest = estimate_bounds(A, inverse_diagonal, smoother.lanczos_steps).highest;
    SparseMatrix P = partition_of_unity(A, inverse_diagonal, settings_.functions, settings_.overlap);
    for (int k = 0; k < settings_.function_smoothing; ++k)
        P = jacobi_smoothed(A, P, kProlongationDamping / highest);

    const double vertices = double(A.rows()) / std::max(1.0, double(P.cols())); // of a function
    smoother.degree = settings_.degree;
    smoother.ratio = std::max(kMinRatio, kRatioPerVertex * vertices);
    cycle_ = VCycle();
    cycle_.end(cycle_.add_level(A, std::move(inverse_diagonal), highest, P, smoother));
}

} // namespace toile::research
