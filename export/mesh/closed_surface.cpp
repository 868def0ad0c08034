#include "export/mesh/closed_surface.h"

#include <algorithm>
#include <set>
#include <utility>

#include "export/cache_layout.h"

namespace toile::exports {

namespace {

/// Without texture coordinates: the sides stay closed at seams.
ObjMesh polygons_of(const ObjMesh& mesh)
{
    ObjMesh faces;
    faces.polygons = mesh.polygons;
    return faces;
}

} // namespace

ClosedSurface::ClosedSurface(const ObjMesh& faces, std::vector<double> thickness)
    : faces_(faces_only(faces)), thickness_(std::move(thickness)), normals_(polygons_of(faces)),
      normal_of_(thickness_.size(), -1)
{
    faces_.colours.clear(); // of vertices that become two
    faces_.lines.clear();
    for (size_t p = 0; p < faces_.polygons.size(); ++p)
        for (size_t k = 0; k < faces_.polygons[p].size(); ++k)
            normal_of_[size_t(faces_.polygons[p][k])] = normals_.indices()[p][k];
    add_rim();
    add_lower_side();
}

/// The upper side's polygons from the other side, in the same groups.
void ClosedSurface::add_lower_side()
{
    const int vertex_count = int(thickness_.size());
    const size_t upper = normals_.indices().size();
    const std::vector<ObjGroup> groups = faces_.groups;
    size_t group = 0;
    if (!groups.empty() && groups.front().first_polygon > 0)
        begin_group(faces_, "", int(faces_.polygons.size()));
    for (size_t p = 0; p < upper; ++p) {
        for (; group < groups.size() && groups[group].first_polygon == int(p); ++group)
            begin_group(faces_, groups[group].name, int(faces_.polygons.size()));
        std::vector<int> polygon(faces_.polygons[p].rbegin(), faces_.polygons[p].rend());
        for (int& v : polygon)
            v += vertex_count;
        faces_.polygons.push_back(std::move(polygon));
        if (!faces_.polygon_uvs.empty())
            faces_.polygon_uvs.emplace_back(faces_.polygon_uvs[p].rbegin(), faces_.polygon_uvs[p].rend());
    }
}

/// A quad at each edge that has a polygon on one side only, in the group "rim" if there are groups.
void ClosedSurface::add_rim()
{
    const int vertex_count = int(thickness_.size());
    std::set<std::pair<int, int>> edges; // from, to
    for (const std::vector<int>& polygon : faces_.polygons)
        for (size_t k = 0; k < polygon.size(); ++k)
            edges.emplace(polygon[k], polygon[(k + 1) % polygon.size()]);
    const size_t upper = faces_.polygons.size();
    if (!faces_.groups.empty())
        begin_group(faces_, "rim", int(upper));
    for (size_t p = 0; p < upper; ++p)
        for (size_t k = 0; k < faces_.polygons[p].size(); ++k) {
            const size_t next = (k + 1) % faces_.polygons[p].size();
            const int from = faces_.polygons[p][k], to = faces_.polygons[p][next];
            if (edges.contains({to, from}))
                continue;
            faces_.polygons.push_back({to, from, from + vertex_count, to + vertex_count});
            if (!faces_.polygon_uvs.empty()) {
                const int uv_from = faces_.polygon_uvs[p][k], uv_to = faces_.polygon_uvs[p][next];
                faces_.polygon_uvs.push_back({uv_to, uv_from, uv_from, uv_to});
            }
        }
}

std::vector<Vec3> ClosedSurface::positions(View<const Vec3> cloth) const
{
    const std::vector<Vec3> normals = normals_.at(cloth);
    const size_t count = thickness_.size();
    std::vector<Vec3> positions(2 * count);
    for (size_t v = 0; v < count; ++v) {
        const Vec3 offset = normal_of_[v] < 0 ? Vec3(Vec3::Zero())
                                              : Vec3(0.5 * thickness_[v] * normals[size_t(normal_of_[v])]);
        positions[v] = cloth[int(v)] + offset;
        positions[count + v] = cloth[int(v)] - offset;
    }
    return positions;
}

std::vector<Vec3> ClosedSurface::middle(View<const Vec3> positions)
{
    const int count = positions.size() / 2;
    std::vector<Vec3> middle;
    middle.reserve(size_t(count));
    for (int v = 0; v < count; ++v)
        middle.push_back(0.5 * (positions[v] + positions[count + v]));
    return middle;
}

} // namespace toile::exports
