#pragma once

#include <array>

#include "core/compute/types.h"

namespace toile::collision {

/// Primitives of a contact: cloth first, then the collider or the other cloth.
enum class ContactKind {
    kVertexFace,
    kFaceVertex,
    kEdgeEdge,
    kVertexShape,
    kFaceShape,
    kEdgeShape,
    kGuard,
    kTwoSided,
    kClothVertexFace,
    kClothEdgeEdge
};

/// Contact between cloth and a collider or other cloth, as the half space that the cloth point should stay
/// in:
///
///   n . (sum_k weight_k x_k - point) >= offset        offset [m]: the contact thickness
//
//    kVertexFace, kVertexShape     kFaceVertex              kEdgeEdge
//
//          o cloth vertex           ___o___ cloth face       --o-- cloth edge
//          | n                         | n                     | n
//       ___x___ collider face          x collider vertex       x  collider edge (end on)
//                                     / \                      |
//    kFaceShape, kEdgeShape: a cloth face or edge against a corner or edge of a ShapeSkeleton
//    kGuard: any of the first three, of the pairs that may not cross: it presses at a small part of the gap,
//                                      towards the side on which the cloth is
//    kTwoSided: likewise, of cloth behind a surface without an inside: it presses at the whole gap
//    kClothVertexFace, kClothEdgeEdge: both are cloth. Weights are signed, sum 0, and point is zero:
//                                      sum_k weight_k x_k runs from one side to the other.
struct ContactPair {
    std::array<int, 4> vertex{-1, -1, -1, -1};    ///< cloth vertices; -1 at the end if unused
    std::array<double, 4> weight{0., 0., 0., 0.}; ///< against a collider >= 0 with sum 1; 0 if unused
    Vec3 normal = Vec3::UnitY();                  ///< unit, out of the collider, at t1
    Vec3 point = Vec3::Zero();                    ///< collider surface point at t1 [m]
    Vec3 motion = Vec3::Zero();                   ///< displacement of that material point from t0 to t1 [m]
    int collider = -1;                            ///< number passed to detect(); -1 between cloths
    ContactKind kind = ContactKind::kVertexFace;
    /// Collider triangle, vertex or edge, by kind. For a shape: 0 with a cloth vertex, else the number of the
    /// skeleton's corner, or corner count plus edge number.
    int feature = -1;
    /// Stiffness of its energy over that of a whole contact, in (0, 1]. It grows from zero where pairs come
    /// and go with small motions, so that forces do not jump. Projections take every pair for a whole one.
    double share = 1.0;

    /// Number of cloth vertices in use.
    TOILE_HD int count() const
    {
        int used = 1;
        while (used < 4 && vertex[used] >= 0)
            ++used;
        return used;
    }

    TOILE_HD bool is_guard() const { return kind == ContactKind::kGuard; }
    TOILE_HD bool is_between_cloths() const { return kind >= ContactKind::kClothVertexFace; }

    /// sum_k weight_k x_k at cloth positions x [m].
    TOILE_HD Vec3 cloth_point(View<const Vec3> x) const
    {
        Vec3 sum = weight[0] * x[vertex[0]];
        for (int k = 1; k < 4 && vertex[k] >= 0; ++k)
            sum += weight[k] * x[vertex[k]];
        return sum;
    }

    /// n . (sum_k weight_k x_k - point) at cloth positions x [m]: negative inside the collider.
    TOILE_HD double gap(View<const Vec3> x) const { return normal.dot(cloth_point(x) - point); }
};

/// ContactPair::vertex for one to four vertices.
TOILE_HD inline std::array<int, 4> contact_vertices(int a, int b = -1, int c = -1, int d = -1)
{
    return {a, b, c, d};
}

/// True for a pair of a single cloth vertex with a collider that has an outside, guards apart.
TOILE_HD inline bool is_plane(const ContactPair& pair)
{
    return pair.kind < ContactKind::kGuard && pair.vertex[1] < 0;
}

} // namespace toile::collision
