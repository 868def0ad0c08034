#include "collision/geometry/shape_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace toile::collision {

namespace {

/// Bounds of the number of segments about the axis of a round shape.
constexpr int kMinSegments = 12, kMaxSegments = 128;

/// Segments about the axis, a multiple of four. A facet with two sides of length a has its middle a^2 / 4r
/// below the sphere.
int segments_for(double radius, double sag)
{
    const double angle = std::acos(std::max(0.0, 1.0 - 0.5 * sag / radius));
    const int quarter = int(std::ceil(0.25 * std::numbers::pi / std::max(angle, 1e-3)));
    return std::clamp(4 * quarter, kMinSegments, kMaxSegments);
}

/// Two half spheres around (0, +-half_length, 0) and the tube between their rims.
TriangleMesh capsule_surface(double half_length, double radius, int segments)
{
    const int rings = segments / 4; // from the pole of a cap to its rim
    TriangleMesh mesh;
    mesh.positions.push_back(Vec3(0.0, half_length + radius, 0.0));
    const auto add_ring = [&](double angle, double center) {
        for (int s = 0; s < segments; ++s) {
            const double azimuth = 2.0 * std::numbers::pi * s / segments;
            mesh.positions.push_back(Vec3(radius * std::sin(angle) * std::sin(azimuth),
                                          center + radius * std::cos(angle),
                                          radius * std::sin(angle) * std::cos(azimuth)));
        }
    };
    const double step = 0.5 * std::numbers::pi / rings;
    for (int k = 1; k <= rings; ++k)
        add_ring(k * step, half_length);
    for (int k = half_length > 0.0 ? rings : rings + 1; k < 2 * rings; ++k)
        add_ring(k * step, -half_length);
    mesh.positions.push_back(Vec3(0.0, -half_length - radius, 0.0));

    const auto at = [&](int ring, int s) { return 1 + ring * segments + s % segments; };
    const int last = mesh.vertex_count() - 1, ring_count = (last - 1) / segments;
    for (int s = 0; s < segments; ++s) {
        mesh.triangles.push_back(Triangle(0, at(0, s), at(0, s + 1)));
        for (int ring = 0; ring + 1 < ring_count; ++ring) {
            mesh.triangles.push_back(Triangle(at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)));
            mesh.triangles.push_back(Triangle(at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)));
        }
        mesh.triangles.push_back(Triangle(last, at(ring_count - 1, s + 1), at(ring_count - 1, s)));
    }
    return mesh;
}

TriangleMesh box_surface(const Vec3& half)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(Vec3(corner & 1 ? half.x() : -half.x(), corner & 2 ? half.y() : -half.y(),
                                      corner & 4 ? half.z() : -half.z()));
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, 1}) {
            const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, first = side << axis;
            const int second = first + (side == 1 ? u : v), fourth = first + (side == 1 ? v : u);
            mesh.triangles.push_back(Triangle(first, second, first + u + v));
            mesh.triangles.push_back(Triangle(first, first + u + v, fourth));
        }
    return mesh;
}

} // namespace

TriangleMesh shape_surface(const Shape& shape, double sag)
{
    if (const auto* sphere = std::get_if<SphereShape>(&shape))
        return capsule_surface(0.0, sphere->radius, segments_for(sphere->radius, sag));
    if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
        return capsule_surface(capsule->half_length, capsule->radius, segments_for(capsule->radius, sag));
    if (const auto* box = std::get_if<BoxShape>(&shape))
        return box_surface(box->half_extent);
    return {};
}

} // namespace toile::collision
