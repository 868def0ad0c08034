#pragma once

/// Closest points of solids in closed form, with the same bodies on CPU and GPU.

#include <cmath>

#include "collision/geometry/shapes.h"

namespace toile::collision {

/// Closest point on the ball around `center`; `fallback` is the normal if x is the centre.
TOILE_HD inline ShapePoint closest_on_ball(const Vec3& center, double radius, const Vec3& x,
                                           const Vec3& fallback)
{
    const Vec3 offset = x - center;
    const double distance = offset.norm();
    const Vec3 normal = distance > 0.0 ? Vec3(offset / distance) : fallback;
    return {center + radius * normal, normal, distance - radius};
}

// In the solid's own frame.

TOILE_HD inline ShapePoint closest_local(const PlaneShape& plane, const Vec3& x)
{
    const double height = plane.normal.dot(x);
    return {x - height * plane.normal, plane.normal, height};
}

TOILE_HD inline ShapePoint closest_local(const SphereShape& sphere, const Vec3& x)
{
    return closest_on_ball(Vec3::Zero(), sphere.radius, x, Vec3::UnitY());
}

TOILE_HD inline ShapePoint closest_local(const CapsuleShape& capsule, const Vec3& x)
{
    const double along = std::fmin(std::fmax(x.y(), -capsule.half_length), capsule.half_length);
    return closest_on_ball(Vec3(0.0, along, 0.0), capsule.radius, x, Vec3::UnitX());
}

TOILE_HD inline ShapePoint closest_local(const BoxShape& box, const Vec3& x)
{
    // Outside: clamp to the box. The normal follows the offset, so it rotates smoothly around edges.
    const Vec3 clamped = x.cwiseMax(-box.half_extent).cwiseMin(box.half_extent);
    const double distance = (x - clamped).norm();
    if (distance > 0.0)
        return {clamped, (x - clamped) / distance, distance};

    // Inside: the nearest face.
    const Vec3 depth = box.half_extent - x.cwiseAbs();
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (depth[k] < depth[axis])
            axis = k;
    ShapePoint result;
    result.normal = Vec3::Zero();
    result.normal[axis] = x[axis] < 0.0 ? -1.0 : 1.0;
    result.point = x;
    result.point[axis] = result.normal[axis] * box.half_extent[axis];
    result.signed_distance = -depth[axis];
    return result;
}

/// world_from_shape as plain data.
struct SolidPose {
    Mat3 rotation = Mat3::Identity();
    Vec3 origin = Vec3::Zero(); ///< [m]

    TOILE_HD Vec3 world(const Vec3& local) const { return rotation * local + origin; }
    TOILE_HD Vec3 local(const Vec3& world) const { return rotation.transpose() * (world - origin); }
    /// Transforms a closest point from the solid's frame to the world.
    TOILE_HD ShapePoint world(const ShapePoint& local) const
    {
        return {world(local.point), rotation * local.normal, local.signed_distance};
    }
};
inline SolidPose solid_pose(const Eigen::Isometry3d& pose) { return {pose.linear(), pose.translation()}; }

/// Shape that moves rigidly during the step, as plain data.
/// @tparam Solid  PlaneShape, SphereShape, CapsuleShape or BoxShape
template <typename Solid>
struct MovingSolid {
    Solid solid;
    SolidPose t0, t1;

    /// Closest surface point at t1.
    TOILE_HD ShapePoint closest(const Vec3& x) const { return t1.world(closest_local(solid, t1.local(x))); }

    /// Displacement from t0 to t1 [m] of the material point that is at `point` at t1.
    TOILE_HD Vec3 motion(const Vec3& point) const { return point - t0.world(t1.local(point)); }
};

} // namespace toile::collision
