#pragma once

#include <vector>

#include "collision/untangle/joined_cloths.h"

namespace toile {

/// A place where an edge of the cloths goes through one of their triangles.
struct Piercing {
    int edge = -1;
    int triangle = -1;
    double s = 0.0;                  ///< of the edge, from vertex[0] (0) to vertex[1] (1)
    Vec3 barycentric = Vec3::Zero(); ///< weights of the triangle's corners
    Vec3 point = Vec3::Zero();       ///< [m]
};

/// Every edge against every triangle that it shares no vertex with, sorted by edge, then by triangle. In
/// double precision: what touches to the last bits may be missed.
/// @param x  [vertices] [m]
std::vector<Piercing> find_piercings(const JoinedCloths& cloths, View<const Vec3> x);

} // namespace toile
