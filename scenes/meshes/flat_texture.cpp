#include "scenes/meshes/flat_texture.h"

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "scenes/meshes/mesh_file.h"

namespace toile::scenes {

namespace {

const char* const kOrShape = ", or write \"rest\": \"shape\"";

std::string text_of(const Vec2& point)
{
    char text[64];
    std::snprintf(text, sizeof text, "(%.6g, %.6g)", point.x(), point.y());
    return text;
}

void require_texture(const ObjMesh& mesh, const std::string& source)
{
    if (!mesh.polygon_uvs.empty())
        return;
    if (mesh.first_plain_line > 0)
        throw InvalidInput(
            source + ":" + std::to_string(mesh.first_plain_line) +
            ": the face has no texture coordinates, which \"rest\": \"uv\" needs at every corner; write " +
            "its corners as v/vt" + kOrShape);
    throw InvalidInput(source +
                       ": has no texture coordinates, which \"rest\": \"uv\" needs; export it with " + "UVs" +
                       kOrShape);
}

/// Polygon of every triangle of triangulated().
std::vector<int> polygons_of_triangles(const ObjMesh& mesh)
{
    std::vector<int> polygon;
    for (int f = 0; f < int(mesh.polygons.size()); ++f)
        polygon.insert(polygon.end(), mesh.triangles_of(f).size(), f);
    return polygon;
}

bool has_area(const FlatTriangle& triangle)
{
    TriangleMesh one;
    for (const Vec2& corner : triangle)
        one.positions.emplace_back(corner.x(), corner.y(), 0.0);
    one.triangles = {Triangle(0, 1, 2)};
    return defect_of(one, 0).empty();
}

/// Side of a triangle in the surface and in the texture plane.
struct Side {
    int low, high;        ///< vertices, in ascending order
    Vec2 at_low, at_high; ///< in the texture plane
    bool is_left = false; ///< the triangle lies to the left of the way from low to high
    int triangle;

    auto key() const { return std::tie(low, high, at_low.x(), at_low.y(), at_high.x(), at_high.y()); }
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles, const std::vector<FlatTriangle>& flat)
{
    std::vector<Side> sides;
    for (int t = 0; t < int(triangles.size()); ++t)
        for (int k = 0; k < 3; ++k) {
            int a = k, b = (k + 1) % 3;
            if (triangles[t][a] > triangles[t][b])
                std::swap(a, b);
            const Vec2 &low = flat[t][a], &high = flat[t][b];
            sides.push_back({triangles[t][a], triangles[t][b], low, high,
                             signed_area({low, high, flat[t][(k + 2) % 3]}) > 0.0, t});
        }
    std::stable_sort(sides.begin(), sides.end(),
                     [](const Side& a, const Side& b) { return a.key() < b.key(); });
    return sides;
}

/// A polygon may not fold over itself. Polygons that lie on each other beyond a common edge are halves of a
/// garment that mirror each other.
void require_unfolded(const ObjMesh& mesh, const std::vector<FlatTriangle>& flat,
                      const std::vector<int>& polygon, const std::string& source)
{
    const std::vector<Side> sides = sorted_sides(mesh.triangulated().triangles, flat);
    for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        end = begin + 1;
        while (end < sides.size() && sides[begin].key() == sides[end].key())
            ++end;
        const Side &a = sides[begin], &b = sides[end - 1];
        const int folded = polygon[size_t(a.triangle)];
        if (end - begin == 2 && a.is_left == b.is_left && folded == polygon[size_t(b.triangle)])
            throw InvalidInput(name_of_face(mesh, folded, source) +
                               ": the face folds over itself in the texture plane, along " +
                               text_of(a.at_low) + " to " + text_of(a.at_high) +
                               "; unfold the texture there" + kOrShape);
    }
}

} // namespace

void require_flat_texture(const ObjMesh& mesh, const std::string& source)
{
    require_texture(mesh, source);
    const std::vector<FlatTriangle> flat = texture_triangles(mesh);
    const std::vector<int> polygon = polygons_of_triangles(mesh);
    for (size_t t = 0; t < flat.size(); ++t)
        if (!has_area(flat[t]))
            throw InvalidInput(name_of_face(mesh, polygon[t], source) +
                               ": the face has no area in the texture plane: its corners are at " +
                               text_of(flat[t][0]) + ", " + text_of(flat[t][1]) + " and " +
                               text_of(flat[t][2]) + "; unwrap it there" + kOrShape);
    require_unfolded(mesh, flat, polygon, source);
}

} // namespace toile::scenes
