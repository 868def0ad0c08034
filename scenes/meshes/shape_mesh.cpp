#include "scenes/meshes/shape_mesh.h"

#include <cmath>
#include <numbers>

namespace toile::scenes {

namespace {

constexpr int kSegments = 48; ///< about the axis of a capsule
constexpr int kRings = 12;    ///< from the pole of a cap to its rim

/// Appends a quad of separate vertices, counter-clockwise seen from outside.
void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    const int first = mesh.vertex_count();
    mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
    mesh.triangles.push_back(Triangle(first, first + 1, first + 2));
    mesh.triangles.push_back(Triangle(first, first + 2, first + 3));
}

TriangleMesh box_mesh(const Vec3& half)
{
    TriangleMesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 center = Vec3::Zero(), u = Vec3::Zero(), v = Vec3::Zero();
            center[axis] = side * half[axis];
            u[(axis + 1) % 3] = half[(axis + 1) % 3];
            v[(axis + 2) % 3] = side * half[(axis + 2) % 3];
            add_quad(mesh, center - u - v, center + u - v, center + u + v, center - u + v);
        }
    return mesh;
}

/// Two half spheres around (0, +-half_length, 0) and the tube between their rims.
TriangleMesh capsule_mesh(double half_length, double radius)
{
    TriangleMesh mesh;
    mesh.positions.push_back(Vec3(0.0, half_length + radius, 0.0));
    const auto add_ring = [&](double angle, double center) {
        for (int s = 0; s < kSegments; ++s) {
            const double azimuth = 2.0 * std::numbers::pi * s / kSegments;
            mesh.positions.push_back(Vec3(radius * std::sin(angle) * std::sin(azimuth),
                                          center + radius * std::cos(angle),
                                          radius * std::sin(angle) * std::cos(azimuth)));
        }
    };
    const double step = 0.5 * std::numbers::pi / kRings;
    for (int k = 1; k <= kRings; ++k)
        add_ring(k * step, half_length);
    for (int k = kRings; k < 2 * kRings; ++k)
        add_ring(k * step, -half_length);
    mesh.positions.push_back(Vec3(0.0, -half_length - radius, 0.0));

    const auto at = [](int ring, int s) { return 1 + ring * kSegments + s % kSegments; };
    const int last = mesh.vertex_count() - 1;
    for (int s = 0; s < kSegments; ++s) {
        mesh.triangles.push_back(Triangle(0, at(0, s), at(0, s + 1)));
        for (int ring = 0; ring + 1 < 2 * kRings; ++ring) {
            mesh.triangles.push_back(Triangle(at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)));
            mesh.triangles.push_back(Triangle(at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)));
        }
        mesh.triangles.push_back(Triangle(last, at(2 * kRings - 1, s + 1), at(2 * kRings - 1, s)));
    }
    return mesh;
}

} // namespace

TriangleMesh shape_mesh(const collision::Shape& shape, double plane_side)
{
    if (const auto* sphere = std::get_if<collision::SphereShape>(&shape))
        return capsule_mesh(0.0, sphere->radius);
    if (const auto* capsule = std::get_if<collision::CapsuleShape>(&shape))
        return capsule_mesh(capsule->half_length, capsule->radius);
    if (const auto* box = std::get_if<collision::BoxShape>(&shape))
        return box_mesh(box->half_extent);
    const double h = 0.5 * plane_side;
    TriangleMesh mesh;
    add_quad(mesh, Vec3(-h, 0, -h), Vec3(-h, 0, h), Vec3(h, 0, h), Vec3(h, 0, -h));
    return mesh;
}

} // namespace toile::scenes
