#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/error.h"

namespace toile {

std::string defect_of(const TriangleMesh& mesh, int triangle)
{
    const Triangle& corner = mesh.triangles[triangle];
    for (const int v : corner)
        if (v < 0 || v >= mesh.vertex_count())
            return "uses vertex " + std::to_string(v) + "; the mesh has vertices 0 to " +
                   std::to_string(mesh.vertex_count() - 1);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
        return "uses a vertex twice; remove the triangle";

    const Vec3& a = mesh.positions[corner[0]];
    const Vec3& b = mesh.positions[corner[1]];
    const Vec3& c = mesh.positions[corner[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double doubled_area = (b - a).cross(c - a).norm();
    if (!(doubled_area > kMinHeightRatio * longest * longest))
        return "has no area (height below 1e-6 of its longest edge); remove it or merge its vertices";
    return {};
}

Bounds bounds(View<const Vec3> points)
{
    Bounds box;
    for (const Vec3& point : points)
        box.extend(point);
    return box;
}

void require_in_range(View<const Vec3> points, const std::string& source)
{
    for (int v = 0; v < points.size(); ++v) {
        const Vec3& p = points[v];
        if (is_in_range(p))
            continue;
        char at[128];
        std::snprintf(at, sizeof at, ": vertex %d is at (%.6g, %.6g, %.6g) m", v, p.x(), p.y(), p.z());
        throw InvalidInput(source + at + "; coordinates must be finite and at most 100 km");
    }
}

void require_usable(const TriangleMesh& mesh, const std::string& source)
{
    if (mesh.triangles.empty())
        throw InvalidInput(source + ": the mesh has no triangle; a surface needs at least one face");
    const auto refuse = [&](const char* what, int number, const std::string& why) {
        throw InvalidInput(source + ": " + what + " " + std::to_string(number) + " " + why);
    };
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.positions[v].allFinite())
            refuse("vertex", v, "is not finite; every coordinate must be a number");
    for (int t = 0; t < mesh.triangle_count(); ++t)
        if (const std::string defect = defect_of(mesh, t); !defect.empty())
            refuse("triangle", t, defect);
}

std::vector<Vec3> vertex_normals(View<const Vec3> positions, View<const Triangle> triangles)
{
    std::vector<Vec3> normals(positions.size(), Vec3::Zero());
    for (const Triangle& corner : triangles) {
        const Vec3& a = positions[corner[0]];
        const Vec3 doubled_area = (positions[corner[1]] - a).cross(positions[corner[2]] - a);
        for (const int v : corner)
            normals[v] += doubled_area;
    }
    for (Vec3& normal : normals)
        if (const double length = normal.norm(); length > 0.0)
            normal /= length;
    return normals;
}

TriangleMesh subdivide(const TriangleMesh& mesh, int levels)
{
    TriangleMesh fine = mesh;
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<int, int>, int> midpoint_of;
        const auto midpoint = [&](int a, int b) {
            const auto [entry, is_new] = midpoint_of.try_emplace(std::minmax(a, b), fine.vertex_count());
            if (is_new)
                fine.positions.push_back(0.5 * (fine.positions[a] + fine.positions[b]));
            return entry->second;
        };
        std::vector<Triangle> split;
        split.reserve(4 * fine.triangles.size());
        for (const Triangle& t : fine.triangles) {
            const int ab = midpoint(t[0], t[1]);
            const int bc = midpoint(t[1], t[2]);
            const int ca = midpoint(t[2], t[0]);
            split.insert(split.end(), {Triangle(t[0], ab, ca), Triangle(ab, t[1], bc), Triangle(ca, bc, t[2]),
                                       Triangle(ab, bc, ca)});
        }
        fine.triangles = std::move(split);
    }
    return fine;
}

} // namespace toile
