#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::testing {

/// Axis-aligned box from lower to upper: 8 vertices, 12 triangles, facing outwards.
inline TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper)
{
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.push_back(Vec3(corner & 1 ? upper.x() : lower.x(), corner & 2 ? upper.y() : lower.y(),
                                      corner & 4 ? upper.z() : lower.z()));
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// Sphere from a subdivided octahedron: 8 * 4^levels triangles, facing outwards.
inline TriangleMesh sphere_mesh(const Vec3& center, double radius, int levels)
{
    TriangleMesh mesh;
    mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    mesh = subdivide(mesh, levels);
    for (Vec3& x : mesh.positions)
        x = center + radius * x.normalized();
    return mesh;
}

/// Horizontal square sheet, cells x cells quads, normals up, centred above (0, height, 0).
inline TriangleMesh sheet_mesh(double side, int cells, double height)
{
    TriangleMesh mesh;
    for (int j = 0; j <= cells; ++j)
        for (int i = 0; i <= cells; ++i)
            mesh.positions.push_back(
                Vec3(side * (double(i) / cells - 0.5), height, side * (double(j) / cells - 0.5)));
    for (int j = 0; j < cells; ++j)
        for (int i = 0; i < cells; ++i) {
            const int a = j * (cells + 1) + i;
            const int b = a + 1;
            const int c = a + cells + 1;
            const int d = c + 1;
            mesh.triangles.push_back(Triangle(a, c, b));
            mesh.triangles.push_back(Triangle(b, c, d));
        }
    return mesh;
}

/// Both meshes in one, the second's indices shifted.
inline TriangleMesh merged(TriangleMesh first, const TriangleMesh& second)
{
    const int shift = first.vertex_count();
    first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
    for (const Triangle& t : second.triangles)
        first.triangles.push_back(t + Triangle::Constant(shift));
    return first;
}

} // namespace toile::testing
