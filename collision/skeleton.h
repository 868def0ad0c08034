#pragma once

#include <array>
#include <vector>

#include "collision/shapes.h"

namespace toile {

/// What cloth faces and edges can meet of a convex solid besides its flat faces: corners and edges, thickened
/// by a radius. In space at one time.
///
///   sphere   one corner (its centre), thickened
///   capsule  two corners and the edge between them, thickened
///   box      eight corners, twelve edges, sharp
///   plane    none: cloth vertices alone meet it
struct ShapeSkeleton {
    struct Corner {
        Vec3 point;
        std::array<Vec3, 3> faces; ///< unit normals of the faces that meet here; unused where round
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

} // namespace toile
