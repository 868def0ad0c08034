#pragma once

#include <string>
#include <variant>

#include <Eigen/Geometry>

#include "core/compute/types.h"

namespace toile::collision {

// Solid bodies in their own frame; a pose (world_from_shape) places them in the world.

/// Half space below the plane through the origin.
struct PlaneShape {
    Vec3 normal = Vec3::UnitY(); ///< unit, out of the solid
};

/// Ball around the origin.
struct SphereShape {
    double radius = 0.5; ///< [m]
};

/// Capsule: all points within `radius` of the segment from -half_length to +half_length on the y axis.
struct CapsuleShape {
    double half_length = 0.5; ///< [m] 0 makes it a sphere
    double radius = 0.1;      ///< [m]
};

/// Box around the origin with sharp edges.
struct BoxShape {
    Vec3 half_extent = Vec3::Constant(0.5); ///< [m]
};

using Shape = std::variant<PlaneShape, SphereShape, CapsuleShape, BoxShape>;

/// Point of a shape's surface closest to a query point.
struct ShapePoint {
    Vec3 point = Vec3::Zero();    ///< [m]
    Vec3 normal = Vec3::UnitY();  ///< unit gradient of the signed distance, out of the solid
    double signed_distance = 0.0; ///< [m] negative inside
};

/// Closest surface point, exact. If several points are equally close (a sphere's centre, a box's medial
/// planes) the choice is fixed: the y axis for sphere and plane, the x axis for a capsule, the lowest axis
/// for a box.
/// @param pose  world_from_shape
ShapePoint closest(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& x);

/// @throws InvalidInput naming `source`, the size and its value: radii and half extents must be positive and
///         finite, half_length not negative, the plane's normal a unit vector.
void require_usable(const Shape& shape, const std::string& source);

} // namespace toile::collision
