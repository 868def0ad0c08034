#pragma once

#include <array>

#include "core/backend/types.h"

namespace toile {

/// What touches what: cloth first, collider second.
enum class ContactKind { kVertexFace, kFaceVertex, kEdgeEdge, kVertexShape, kFaceShape, kEdgeShape };

/// A place where cloth is near a collider: the half space that the cloth point should stay in,
///
///   n . (sum_k weight_k x_k - point) >= offset        offset [m]: the contact thickness
//
//    kVertexFace, kVertexShape     kFaceVertex              kEdgeEdge
//
//          o cloth vertex           ___o___ cloth face       --o-- cloth edge
//          | n                         | n                     | n
//       ___x___ collider face          x collider vertex       x  collider edge (end on)
//                                     / \                      |
//    kFaceShape, kEdgeShape: a cloth face or edge against a corner or edge of a Skeleton
struct ContactPair {
    std::array<int, 3> vertex{-1, -1, -1};    ///< cloth vertices; -1 unused
    std::array<double, 3> weight{0., 0., 0.}; ///< >= 0, sum 1; 0 where unused
    Vec3 normal = Vec3::UnitY();              ///< unit, out of the collider, at t1
    Vec3 point = Vec3::Zero();                ///< collider surface point at t1 [m]
    Vec3 motion = Vec3::Zero();               ///< displacement of that material point from t0 to t1 [m]
    int collider = -1;                        ///< as given to detect()
    ContactKind kind = ContactKind::kVertexFace;
    /// Collider triangle, vertex or edge by kind; of a shape 0 with a cloth vertex, else the number of the
    /// skeleton's corner, or its edge's after all corners.
    int feature = -1;

    /// sum_k weight_k x_k at cloth positions x [m].
    Vec3 cloth_point(View<const Vec3> x) const
    {
        Vec3 sum = weight[0] * x[vertex[0]];
        for (int k = 1; k < 3 && vertex[k] >= 0; ++k)
            sum += weight[k] * x[vertex[k]];
        return sum;
    }

    /// n . (sum_k weight_k x_k - point) at cloth positions x [m]: negative inside the collider.
    double gap(View<const Vec3> x) const { return normal.dot(cloth_point(x) - point); }
};

} // namespace toile
