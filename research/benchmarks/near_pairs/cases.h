#pragma once

#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::research::near_pairs {

/// A cloth for the search, edges about 1 cm long.
struct Case {
    std::string name;
    std::vector<Triangle> triangles;
    std::vector<Vec3> x; ///< [m]
};

/// A flat square; one crumpled by random waves (it crosses itself, which does not affect the search); twenty
/// flat ones 3 mm above each other. About `vertices` in all.
std::vector<Case> cases(int vertices);

} // namespace toile::research::near_pairs
