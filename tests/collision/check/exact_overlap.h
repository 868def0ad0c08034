#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::test {

/// Oracle for crossings: true if the hulls of the points a and b have a common point outside the hull of
/// `shared`, at most two points that both contain. Clips one polygon with the half spaces of the other in
/// rational arithmetic, for hulls of any dimension.
bool overlap_beyond(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const std::vector<Vec3>& shared);

} // namespace toile::test
