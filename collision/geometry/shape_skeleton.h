#pragma once

#include <array>
#include <vector>

#include "collision/geometry/shapes.h"

namespace toile::collision {

/// Corners and edges of a convex solid, thickened by a radius, in world space at one time: the features
/// besides flat faces that cloth faces and edges can meet.
///
///   sphere   one corner (its centre), thickened
///   capsule  two corners and the edge between them, thickened
///   box      eight corners, twelve edges, sharp
///   plane    none: cloth vertices alone meet it
struct ShapeSkeleton {
    struct Corner {
        Vec3 point;
        std::array<Vec3, 3> faces; ///< unit normals of the adjacent faces; unused if round
    };
    struct Edge {
        Vec3 a, b;
        std::array<Vec3, 2> faces;
    };

    std::vector<Corner> corners;
    std::vector<Edge> edges;
    double radius = 0.0; ///< [m] 0: sharp, with faces

    std::vector<Vec3> points() const; ///< the corners
    bool is_round() const { return radius > 0.0; }

    /// Distance from x to the nearest corner or edge, thickened [m]; negative within the thickness.
    double distance(const Vec3& x) const;
};

/// @param pose  world_from_shape
ShapeSkeleton skeleton_of(const Shape& shape, const Eigen::Isometry3d& pose);

} // namespace toile::collision
