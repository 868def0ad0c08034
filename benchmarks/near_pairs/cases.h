#pragma once

#include <string>
#include <vector>

#include "core/backend/types.h"

namespace toile::near_pairs {

/// Cloth to search for pairs, edges about 1 cm long.
struct Case {
    std::string name;
    std::vector<Triangle> triangles;
    std::vector<Vec3> x; ///< [m]
};

/// A flat square; one crumpled by random waves (it crosses itself, which the search does not mind); twenty
/// flat ones 3 mm above each other. About `vertices` in all.
std::vector<Case> cases(int vertices);

} // namespace toile::near_pairs
