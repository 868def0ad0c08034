#include "scenes/meshes/shape_mesh.h"

#include "collision/geometry/shape_surface.h"

namespace toile::scenes {

namespace {

/// Depth of facets below a round shape, relative to its radius [-]: 48 segments about its axis.
constexpr double kSag = 0.0045;

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

} // namespace

TriangleMesh shape_mesh(const collision::Shape& shape, double plane_side)
{
    if (const auto* sphere = std::get_if<collision::SphereShape>(&shape))
        return collision::shape_surface(shape, kSag * sphere->radius);
    if (const auto* capsule = std::get_if<collision::CapsuleShape>(&shape))
        return collision::shape_surface(shape, kSag * capsule->radius);
    if (const auto* box = std::get_if<collision::BoxShape>(&shape))
        return box_mesh(box->half_extent);
    const double h = 0.5 * plane_side;
    TriangleMesh mesh;
    add_quad(mesh, Vec3(-h, 0, -h), Vec3(-h, 0, h), Vec3(h, 0, h), Vec3(h, 0, -h));
    return mesh;
}

} // namespace toile::scenes
