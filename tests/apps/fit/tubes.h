#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "apps/toile/maps/fitted_garment.h"

namespace toile::test {

inline constexpr int kSides = 48, kRings = 10;
inline constexpr double kHeight = 1.0; ///< [m] of a tube

/// Circumference over radius of a tube's polygon [-].
inline double circumference() { return 2.0 * kSides * std::sin(std::numbers::pi / kSides); }

/// Tube about Y from 0 to kHeight, of a polygon of kSides corners on a circle, open at both ends.
/// @param slit  leaves out the last side
inline TriangleMesh tube(double radius, bool slit = false)
{
    TriangleMesh mesh;
    for (int j = 0; j <= kRings; ++j)
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / kSides;
            mesh.positions.emplace_back(radius * std::sin(angle), kHeight * j / kRings,
                                        radius * std::cos(angle));
        }
    for (int j = 0; j < kRings; ++j)
        for (int i = 0; i < kSides - (slit ? 1 : 0); ++i) {
            const int a = j * kSides + i, b = j * kSides + (i + 1) % kSides;
            mesh.triangles.emplace_back(a, b, b + kSides);
            mesh.triangles.emplace_back(a, b + kSides, a + kSides);
        }
    return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& by)
{
    for (Vec3& x : mesh.positions)
        x += by;
    return mesh;
}

inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b)
{
    const int first = a.vertex_count();
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const Triangle& t : b.triangles)
        a.triangles.push_back((t.array() + first).matrix());
    return a;
}

/// Triangles laid flat one by one, shrunk so that the mesh is stretched by `stretch` in all directions.
inline std::vector<FlatTriangle> flat(const TriangleMesh& mesh, double stretch = 1.0)
{
    std::vector<FlatTriangle> rest;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions[size_t(t[1])] - mesh.positions[size_t(t[0])],
                   b = mesh.positions[size_t(t[2])] - mesh.positions[size_t(t[0])];
        const double along = b.dot(a.normalized());
        rest.push_back({Vec2(0.0, 0.0), Vec2(a.norm(), 0.0) / stretch,
                        Vec2(along, (b - along * a.normalized()).norm()) / stretch});
    }
    return rest;
}

} // namespace toile::test
