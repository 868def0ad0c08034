#pragma once

#include <vector>

#include "research/benchmarks/stress/cases.h"

namespace toile::research::stress {

/// Random positions that are equal on every platform, unlike std::uniform_real_distribution.
std::vector<Vec3> random_positions(const RandomStart& start, size_t count);

} // namespace toile::research::stress
