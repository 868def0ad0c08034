#include "apps/preview/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include "core/base/error.h"

namespace toile::preview {

namespace {

/// Fraction of the picture left free around the points [-].
constexpr double kMargin = 0.08;

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Position of a 2-D camera looking along depth z that sees all points within slope |x - cx| <= t (z - cz):
/// the intersection of the two outermost sight lines, which touch the points at a and b.
struct SlopeFit {
    double outermost_right = -std::numeric_limits<double>::infinity(); ///< max of  x - t z
    double outermost_left = -std::numeric_limits<double>::infinity();  ///< max of -x - t z
    double slope;

    explicit SlopeFit(double t) : slope(t) {}
    void extend(double x, double z)
    {
        outermost_right = std::max(outermost_right, x - slope * z);
        outermost_left = std::max(outermost_left, -x - slope * z);
    }
    double position() const { return 0.5 * (outermost_right - outermost_left); }
    double depth() const { return -(outermost_right + outermost_left) / (2.0 * slope); }
};

void require_sane(View<const Vec3> points, const CameraSettings& settings)
{
    if (points.empty())
        throw InvalidInput("camera: there is nothing to show; give it a mesh with vertices");
    if (!(settings.fov_deg >= 1.0 && settings.fov_deg <= 120.0))
        throw InvalidInput("camera: fov " + std::to_string(settings.fov_deg) +
                           " degrees; it must be 1 to 120");
    if (!(std::abs(settings.elevation_deg) < 90.0))
        throw InvalidInput("camera: elevation " + std::to_string(settings.elevation_deg) +
                           " degrees; it must lie between -90 and 90");
    if (!(settings.zoom > 0.0))
        throw InvalidInput("camera: zoom " + std::to_string(settings.zoom) + "; it must be positive");
}

} // namespace

Vec2 Camera::picture_coordinates(double column, double row) const
{
    return {2.0 * (crop.left + (crop.right - crop.left) * column) - 1.0,
            1.0 - 2.0 * (crop.top + (crop.bottom - crop.top) * row)};
}

Vec3 Camera::direction(double x, double y) const
{
    return (forward + tan_half_fov * (aspect * x * right + y * up)).normalized();
}

Vec2 Camera::project(const Vec3& point) const
{
    const Vec3 offset = point - origin;
    const double scale = 1.0 / (tan_half_fov * offset.dot(forward));
    return Vec2(scale / aspect * offset.dot(right), scale * offset.dot(up));
}

Camera fit_camera(View<const Vec3> points, const CameraSettings& settings, double aspect)
{
    require_sane(points, settings);

    // Axes of the camera from its two angles.
    const double azimuth = radians(settings.azimuth_deg), elevation = radians(settings.elevation_deg);
    Camera camera;
    camera.aspect = aspect;
    camera.tan_half_fov = std::tan(0.5 * radians(settings.fov_deg));
    camera.forward = -Vec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                           std::cos(azimuth) * std::cos(elevation));
    camera.right = camera.forward.cross(Vec3::UnitY()).normalized();
    camera.up = camera.right.cross(camera.forward);

    // Horizontal and vertical fits give a centre and a depth each; the farther depth fits both.
    const double slope = (1.0 - kMargin) * camera.tan_half_fov;
    SlopeFit across(slope * aspect), upward(slope);
    for (const Vec3& point : points) {
        const double z = point.dot(camera.forward);
        across.extend(point.dot(camera.right), z);
        upward.extend(point.dot(camera.up), z);
    }
    const double depth = std::min(across.depth(), upward.depth());
    camera.origin = across.position() * camera.right + upward.position() * camera.up + depth * camera.forward;
    camera.tan_half_fov /= settings.zoom;
    return camera;
}

Camera aimed_at(Camera camera, const Vec3& target, const Vec3& before)
{
    camera.origin = target - (before - camera.origin).dot(camera.forward) * camera.forward;
    return camera;
}

Camera turned(Camera camera, double angle_deg, const Vec3& pivot)
{
    const Mat3 R = Eigen::AngleAxisd(radians(angle_deg), Vec3::UnitY()).toRotationMatrix();
    camera.origin = pivot + R * (camera.origin - pivot);
    camera.right = R * camera.right;
    camera.up = R * camera.up;
    camera.forward = R * camera.forward;
    return camera;
}

std::vector<Vec3> corners(const Bounds& box)
{
    std::vector<Vec3> points;
    points.reserve(8);
    for (int k = 0; k < 8; ++k)
        points.push_back(Vec3(k & 1 ? box.upper.x() : box.lower.x(), k & 2 ? box.upper.y() : box.lower.y(),
                              k & 4 ? box.upper.z() : box.lower.z()));
    return points;
}

std::vector<Vec3> cylinder_around(const Bounds& box)
{
    constexpr int kSides = 64;
    const Vec3 center = box.center(), half = box.upper - center;
    const double radius = std::hypot(half.x(), half.z());
    std::vector<Vec3> points;
    points.reserve(2 * kSides);
    for (int k = 0; k < kSides; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSides;
        for (const double height : {-half.y(), half.y()})
            points.push_back(center + Vec3(radius * std::sin(angle), height, radius * std::cos(angle)));
    }
    return points;
}

} // namespace toile::preview
