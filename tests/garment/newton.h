#pragma once

#include <functional>
#include <vector>

#include "core/compute/types.h"

namespace toile::test {

/// Value of a function of positions and its gradient (overwritten).
using ValueAndGradient = std::function<double(const std::vector<Vec3>& x, std::vector<Vec3>& gradient)>;

/// Minimises by Newton's method with a dense Hessian from central differences of the gradient: the oracle for
/// small sheets. Negative curvature is mirrored; steps are halved until the value falls.
/// @param fixed  [vertices] 1 where x stays
/// @return max displacement of the last Newton step [m], an estimate of the remaining error
double minimise_by_newton(const ValueAndGradient& function, const std::vector<unsigned char>& fixed,
                          std::vector<Vec3>& x);

} // namespace toile::test
