#pragma once

/// ContactDetector's search of one solid: kernels.

#include "collision/contact_pair.h"
#include "collision/solid.h"

namespace toile {

/// Counts the pair of a cloth vertex.
template <typename Solid>
struct CountVertexShape {
    View<const Vec3> x; ///< [vertices] [m]
    MovingSolid<Solid> solid;
    double radius;    ///< [m]
    View<int> counts; ///< [vertices] out: 0 or 1

    TOILE_HD void operator()(int v) const { counts[v] = int(solid.closest(x[v]).signed_distance < radius); }
};

/// The pair of cloth vertex v and a place on the solid.
template <typename Solid>
TOILE_HD ContactPair vertex_shape_pair(const MovingSolid<Solid>& solid, int collider, int v,
                                       const ShapePoint& at)
{
    ContactPair pair;
    pair.vertex = contact_vertices(v);
    pair.weight = {1.0, 0.0, 0.0, 0.0};
    pair.normal = at.normal;
    pair.point = at.point;
    pair.motion = solid.motion(at.point);
    pair.collider = collider;
    pair.kind = ContactKind::kVertexShape;
    pair.feature = 0;
    return pair;
}

/// The pair of a cloth vertex, if it has one.
template <typename Solid>
struct ReportVertexShape {
    View<const Vec3> x; ///< [vertices] [m]
    MovingSolid<Solid> solid;
    int collider;
    View<const int> counts;  ///< [vertices]
    View<const long> first;  ///< [vertices + 1] their sums
    View<ContactPair> pairs; ///< out, as far as there is room

    TOILE_HD void operator()(int v) const
    {
        if (counts[v] != 0 && first[v] < pairs.size())
            pairs[int(first[v])] = vertex_shape_pair(solid, collider, v, solid.closest(x[v]));
    }
};

} // namespace toile
