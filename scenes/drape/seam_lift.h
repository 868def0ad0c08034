#pragma once

#include <array>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::scenes {

/// Greatest lift of panels before they are sewn [m].
inline constexpr double kMaxLift = 0.12;

/// Height [m] by which panels have to be lifted so that their shoulder seams close over the shoulders instead
/// of being pulled against chest and back, where they slide down: the smallest at which no thread of these
/// seams passes through the body. A shoulder seam is one all of whose threads do where the panels are placed,
/// and none at some lift up to kMaxLift. 0 if there is none.
/// @param stitches  [seams][threads] vertices of both ends
/// @param x         [vertices] of the placed panels [m]
double shoulder_lift(const std::vector<std::vector<std::array<int, 2>>>& stitches, View<const Vec3> x,
                     const TriangleMesh& body);

} // namespace toile::scenes
