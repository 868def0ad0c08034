#include "collision/shapes.h"

#include <cmath>
#include <sstream>

#include "core/backend/error.h"

namespace toile {

namespace {

/// The ball of given radius around `center`; `fallback` is the normal when x is the centre.
ShapePoint closest_on_ball(const Vec3& center, double radius, const Vec3& x, const Vec3& fallback)
{
    const Vec3 offset = x - center;
    const double distance = offset.norm();
    const Vec3 normal = distance > 0.0 ? Vec3(offset / distance) : fallback;
    return {center + radius * normal, normal, distance - radius};
}

ShapePoint closest_local(const PlaneShape& plane, const Vec3& x)
{
    const double height = plane.normal.dot(x);
    return {x - height * plane.normal, plane.normal, height};
}

ShapePoint closest_local(const SphereShape& sphere, const Vec3& x)
{
    return closest_on_ball(Vec3::Zero(), sphere.radius, x, Vec3::UnitY());
}

ShapePoint closest_local(const CapsuleShape& capsule, const Vec3& x)
{
    const double along = std::fmin(std::fmax(x.y(), -capsule.half_length), capsule.half_length);
    return closest_on_ball(Vec3(0.0, along, 0.0), capsule.radius, x, Vec3::UnitX());
}

ShapePoint closest_local(const BoxShape& box, const Vec3& x)
{
    // Outside: clamp to the box; the normal follows the offset, so it turns smoothly around edges.
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

void require_positive(double value, const char* what, const std::string& source)
{
    if (std::isfinite(value) && value > 0.0)
        return;
    std::ostringstream message;
    message << source << ": " << what << " is " << value << "; it must be a positive length in metres";
    throw InvalidInput(message.str());
}

void require_local(const PlaneShape& plane, const std::string& source)
{
    constexpr double kUnit = 1e-6; // [-] how far a direction's length may be from 1
    if (!(std::abs(plane.normal.norm() - 1.0) < kUnit)) {
        std::ostringstream message;
        message << source << ": plane normal (" << plane.normal.transpose()
                << ") is not a unit vector; divide it by its length";
        throw InvalidInput(message.str());
    }
}

void require_local(const SphereShape& sphere, const std::string& source)
{
    require_positive(sphere.radius, "sphere radius", source);
}

void require_local(const CapsuleShape& capsule, const std::string& source)
{
    require_positive(capsule.radius, "capsule radius", source);
    if (capsule.half_length != 0.0)
        require_positive(capsule.half_length, "capsule half length", source);
}

void require_local(const BoxShape& box, const std::string& source)
{
    for (const double half : box.half_extent)
        require_positive(half, "box half extent", source);
}

} // namespace

ShapePoint closest(const Shape& shape, const Eigen::Isometry3d& pose, const Vec3& x)
{
    const Vec3 local = pose.linear().transpose() * (x - pose.translation());
    ShapePoint result = std::visit([&](const auto& solid) { return closest_local(solid, local); }, shape);
    result.point = pose * result.point;
    result.normal = pose.linear() * result.normal;
    return result;
}

void require_usable(const Shape& shape, const std::string& source)
{
    std::visit([&](const auto& solid) { require_local(solid, source); }, shape);
}

} // namespace toile
