#include "core/linear/baselines/multigrid.h"

#include <utility>

#include "core/linear/baselines/aggregation.h"
#include "core/linear/baselines/coarse_functions.h"

namespace toile {

void Multigrid::prepare(SparseMatrix A, std::vector<double> inverse_diagonal)
{
    cycle_ = VCycle();
    double strength = settings_.strength;
    while (A.rows() > settings_.coarsest_size) {
        const SparseMatrix strong = strong_part(A, inverse_diagonal, strength);
        const double highest = estimate_bounds(A, inverse_diagonal, settings_.smoother.lanczos_steps).highest;
        const SparseMatrix groups = characteristic_functions(aggregate(strong));
        SparseMatrix P = jacobi_smoothed(strong, groups, kProlongationDamping / highest);
        A = cycle_.add_level(std::move(A), std::move(inverse_diagonal), highest, std::move(P),
                             settings_.smoother);
        inverse_diagonal = invert_diagonal(A, std::vector<unsigned char>(A.rows(), 0));
        strength *= 0.5;
    }
    cycle_.end(A);
}

} // namespace toile
