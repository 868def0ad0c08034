#include "collision/geometry/shapes.h"

#include <cmath>
#include <sstream>

#include "collision/geometry/solid.h"
#include "core/base/error.h"

namespace toile::collision {

namespace {

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
    constexpr double kUnit = 1e-6; // [-] tolerance of a direction's length around 1
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
    const SolidPose at = solid_pose(pose);
    const Vec3 local = at.local(x);
    return std::visit([&](const auto& solid) { return at.world(closest_local(solid, local)); }, shape);
}

void require_usable(const Shape& shape, const std::string& source)
{
    std::visit([&](const auto& solid) { require_local(solid, source); }, shape);
}

} // namespace toile::collision
