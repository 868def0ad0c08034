#pragma once

#include <vector>

#include "collision/repair/joined_cloths.h"

namespace toile::collision {

/// Intersection of an edge of the cloths with one of their triangles.
struct EdgeTriangleIntersection {
    int edge = -1;
    int triangle = -1;
    double s = 0.0;                  ///< parameter on the edge, from vertex[0] (0) to vertex[1] (1)
    Vec3 barycentric = Vec3::Zero(); ///< weights of the triangle's corners
    Vec3 point = Vec3::Zero();       ///< [m]
};

/// Finds intersections of every edge with every triangle that shares no vertex with it, sorted by edge, then
/// by triangle. In double precision: contacts within rounding may be missed.
/// @param x  [vertices] [m]
std::vector<EdgeTriangleIntersection> find_edge_triangle_intersections(const JoinedCloths& cloths,
                                                                       View<const Vec3> x);

} // namespace toile::collision
