#include "research/linear/multigrid.h"

#include <utility>

#include "research/linear/aggregation.h"
#include "research/linear/coarse_functions.h"

namespace toile::research {

void Multigrid::prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal)
{
    cycle_ = VCycle();
    SparseMatrix level = A;
    double strength = settings_.strength;
    while (level.rows() > settings_.coarsest_size) {
        const SparseMatrix strong = strong_part(level, inverse_diagonal, strength);
        const SparseMatrix groups = characteristic_functions(aggregate(strong));
        const double highest =
            estimate_bounds(level, inverse_diagonal, settings_.smoother.lanczos_steps).highest;
        const SparseMatrix P = jacobi_smoothed(strong, groups, kProlongationDamping / highest);
        level = cycle_.add_level(level, std::move(inverse_diagonal), highest, P, settings_.smoother);
        inverse_diagonal = invert_diagonal(level, std::vector<unsigned char>(level.rows(), 0));
        strength *= 0.5;
    }
    cycle_.end(level);
}

} // namespace toile::research
