#include "research/benchmarks/stress/random_positions.h"

#include <random>

namespace toile::research::stress {

std::vector<Vec3> random_positions(const RandomStart& start, size_t count)
{
    std::mt19937 random(start.seed);
    std::vector<Vec3> positions(count);
    for (Vec3& p : positions)
        for (int axis = 0; axis < 3; ++axis) {
            const double fraction = double(random()) / double(std::mt19937::max());
            p[axis] = start.lower[axis] + fraction * (start.upper[axis] - start.lower[axis]);
        }
    return positions;
}

} // namespace toile::research::stress
