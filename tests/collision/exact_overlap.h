#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// Oracle for crossings: true when the hull of the points a and that of b have a point in common outside the
/// hull of `shared`, at most two points that both contain. By clipping one polygon with the other's half
/// spaces in rational arithmetic, whatever the dimension of either.
bool overlap_beyond(const std::vector<Vec3>& a, const std::vector<Vec3>& b, const std::vector<Vec3>& shared);

} // namespace toile
