#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::research::accuracy {

/// Root of the mean square distance of two sets of as many vertices.
double rms(View<const Vec3> a, View<const Vec3> b);

/// Root of the mean square length.
double rms(View<const Vec3> v);

Vec3 mean(View<const Vec3> x);

/// Value that a share [0, 1] of all values does not exceed.
double quantile(std::vector<double> values, double share);

} // namespace toile::research::accuracy
