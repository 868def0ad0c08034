#include "core/mesh/clean.h"

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/weld.h"

namespace toile {

namespace {

/// Removes the polygons for which `is_dropped` holds, with what is parallel to them.
template <typename IsDropped>
int drop_polygons(ObjMesh& mesh, const IsDropped& is_dropped)
{
    const std::vector<ObjGroup> groups = std::move(mesh.groups);
    mesh.groups.clear();
    auto group = groups.begin();
    size_t kept = 0;
    for (size_t f = 0; f < mesh.polygons.size(); ++f) {
        for (; group != groups.end() && group->first_polygon == int(f); ++group)
            begin_group(mesh, group->name, int(kept));
        if (is_dropped(mesh.polygons[f]))
            continue;
        if (kept != f) {
            mesh.polygons[kept] = std::move(mesh.polygons[f]);
            if (!mesh.polygon_uvs.empty())
                mesh.polygon_uvs[kept] = std::move(mesh.polygon_uvs[f]);
            if (!mesh.polygon_lines.empty())
                mesh.polygon_lines[kept] = mesh.polygon_lines[f];
        }
        ++kept;
    }
    if (!mesh.groups.empty() && mesh.groups.back().first_polygon == int(kept))
        mesh.groups.pop_back();
    const int dropped = int(mesh.polygons.size() - kept);
    mesh.polygons.resize(kept);
    mesh.polygon_uvs.resize(std::min(kept, mesh.polygon_uvs.size()));
    mesh.polygon_lines.resize(std::min(kept, mesh.polygon_lines.size()));
    return dropped;
}

/// Side of a polygon between two points, which are the numbers of equal positions.
struct Side {
    int low, high; ///< points
    int low_vertex, high_vertex;
    int polygon;

    auto key() const { return std::tie(low, high); }
};

/// Sides that one polygon has alone, sorted by their points.
std::vector<Side> border_of(const ObjMesh& mesh, const std::vector<int>& point_of)
{
    std::vector<Side> sides;
    for (int f = 0; f < int(mesh.polygons.size()); ++f) {
        const std::vector<int>& polygon = mesh.polygons[f];
        for (size_t k = 0; k < polygon.size(); ++k) {
            int a = polygon[k], b = polygon[(k + 1) % polygon.size()];
            if (point_of[a] > point_of[b])
                std::swap(a, b);
            sides.push_back({point_of[a], point_of[b], a, b, f});
        }
    }
    const auto vertices = [](const Side& side) {
        return std::tie(side.low, side.high, side.low_vertex, side.high_vertex, side.polygon);
    };
    std::sort(sides.begin(), sides.end(),
              [&](const Side& a, const Side& b) { return vertices(a) < vertices(b); });
    const auto is_same = [](const Side& a, const Side& b) {
        return a.low_vertex == b.low_vertex && a.high_vertex == b.high_vertex;
    };
    std::vector<Side> border;
    for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
        end = begin + 1;
        while (end < sides.size() && is_same(sides[begin], sides[end]))
            ++end;
        if (end - begin == 1 && sides[begin].low != sides[begin].high)
            border.push_back(sides[begin]);
    }
    return border;
}

std::set<int> points_of(const std::vector<int>& polygon, const std::vector<int>& point_of)
{
    std::set<int> points;
    for (const int v : polygon)
        points.insert(point_of[v]);
    return points;
}

} // namespace

int drop_repeated_polygons(ObjMesh& mesh)
{
    std::set<std::vector<int>> seen;
    return drop_polygons(mesh, [&](std::vector<int> corners) {
        std::sort(corners.begin(), corners.end());
        return !seen.insert(std::move(corners)).second;
    });
}

int drop_repeated_corners(ObjMesh& mesh)
{
    int changed = 0;
    for (size_t f = 0; f < mesh.polygons.size(); ++f) {
        std::vector<int>& polygon = mesh.polygons[f];
        const std::vector<int> before = polygon;
        size_t kept = 0;
        for (size_t k = 0; k < before.size(); ++k) {
            if (before[k] == before[(k + 1) % before.size()])
                continue;
            polygon[kept] = before[k];
            if (!mesh.polygon_uvs.empty() && !mesh.polygon_uvs[f].empty())
                mesh.polygon_uvs[f][kept] = mesh.polygon_uvs[f][k];
            ++kept;
        }
        polygon.resize(kept);
        if (!mesh.polygon_uvs.empty() && !mesh.polygon_uvs[f].empty())
            mesh.polygon_uvs[f].resize(kept);
        changed += kept < before.size() ? 1 : 0;
    }
    drop_polygons(mesh, [](const std::vector<int>& polygon) { return polygon.size() < 3; });
    return changed;
}

std::vector<int> stitch(ObjMesh& mesh, double distance)
{
    const std::vector<int> point_of = weld({mesh.positions, {}}, distance).welded_of;
    const std::vector<Side> border = border_of(mesh, point_of);
    DisjointSets joined(int(mesh.positions.size()));
    for (size_t begin = 0, end = 0; begin < border.size(); begin = end) {
        end = begin + 1;
        while (end < border.size() && border[begin].key() == border[end].key())
            ++end;
        if (end - begin != 2)
            continue;
        const Side &a = border[begin], &b = border[begin + 1];
        if (points_of(mesh.polygons[a.polygon], point_of) == points_of(mesh.polygons[b.polygon], point_of))
            continue;
        joined.join(a.low_vertex, b.low_vertex);
        joined.join(a.high_vertex, b.high_vertex);
    }
    std::vector<int> stands(mesh.positions.size());
    for (int v = 0; v < int(stands.size()); ++v)
        stands[v] = joined.find(v);
    for (std::vector<int>& polygon : mesh.polygons)
        for (int& v : polygon)
            v = stands[v];
    for (auto& line : mesh.lines)
        for (int& v : line)
            v = stands[v];
    std::erase_if(mesh.lines, [](const auto& line) { return line[0] == line[1]; });
    return stands;
}

double seam_distance(const ObjMesh& mesh)
{
    Bounds box; // loose vertices may lie anywhere
    for (const std::vector<int>& polygon : mesh.polygons)
        for (const int v : polygon)
            box.extend(mesh.positions[v]);
    return 1e-6 * box.diagonal();
}

TriangleMesh stitched_surface(ObjMesh mesh)
{
    const std::vector<int> stands = stitch(mesh, seam_distance(mesh));
    for (int v = 0; v < int(stands.size()); ++v)
        if (stands[v] != v) {
            drop_loose_vertices(mesh);
            break;
        }
    return mesh.triangulated();
}

void drop_repeated_lines(ObjMesh& mesh)
{
    std::set<std::pair<int, int>> seen;
    std::erase_if(mesh.lines,
                  [&](const auto& line) { return !seen.insert(std::minmax(line[0], line[1])).second; });
}

std::vector<int> drop_loose_vertices(ObjMesh& mesh)
{
    std::vector<char> used(mesh.positions.size(), 0);
    for (const std::vector<int>& polygon : mesh.polygons)
        for (const int v : polygon)
            used[v] = 1;
    std::vector<int> number(used.size(), -1);
    int kept = 0;
    for (size_t v = 0; v < used.size(); ++v) {
        if (used[v] == 0)
            continue;
        mesh.positions[kept] = mesh.positions[v];
        if (!mesh.colours.empty())
            mesh.colours[kept] = mesh.colours[v];
        number[v] = kept++;
    }
    mesh.positions.resize(size_t(kept));
    mesh.colours.resize(std::min(size_t(kept), mesh.colours.size()));
    for (std::vector<int>& polygon : mesh.polygons)
        for (int& v : polygon)
            v = number[v];
    for (auto& line : mesh.lines)
        for (int& v : line)
            v = number[v];
    std::erase_if(mesh.lines, [](const auto& line) { return line[0] < 0 || line[1] < 0; });
    return number;
}

} // namespace toile
