#include "garment/pattern/mesh/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace toile::garment {

namespace {

constexpr double kMinEdge = 0.6, kMaxEdge = 1.6;
constexpr double kSharpCorner = std::numbers::pi / 3.0;

double angle_between(const Vec2& a, const Vec2& b)
{
    return std::atan2(std::abs(a.x() * b.y() - a.y() * b.x()), a.dot(b));
}

double angle_at(const PatternMesh& mesh, const Triangle& t, int corner)
{
    const Vec2& x = mesh.uv[t[corner]];
    return angle_between(mesh.uv[t[(corner + 1) % 3]] - x, mesh.uv[t[(corner + 2) % 3]] - x);
}

double smallest_angle(const PatternMesh& mesh, const Triangle& t)
{
    return std::min({angle_at(mesh, t, 0), angle_at(mesh, t, 1), angle_at(mesh, t, 2)});
}

struct OutlineVertices {
    std::vector<bool> is_outline; ///< [vertices]
    std::vector<bool> is_forced;  ///< [vertices] the outline is sharp here or has a short side

    bool force(const Triangle& t) const
    {
        return is_forced[t[0]] || is_forced[t[1]] || is_forced[t[2]] ||
               (is_outline[t[0]] && is_outline[t[1]] && is_outline[t[2]]);
    }
};

/// Panels of a mesh from one to before another.
struct PanelRange {
    int begin, end;

    View<const Triangle> triangles(const PatternMesh& mesh) const
    {
        const int first = mesh.first_triangle[begin];
        return View<const Triangle>(mesh.triangles.data() + first, mesh.first_triangle[end] - first);
    }
};

OutlineVertices outline_vertices(const PatternMesh& mesh, const PanelRange& panels)
{
    std::vector<double> angles(mesh.vertex_count(), 0.0);
    for (const Triangle& t : panels.triangles(mesh))
        for (int k = 0; k < 3; ++k)
            angles[t[k]] += angle_at(mesh, t, k);
    std::vector<bool> is_outline(mesh.vertex_count(), false), is_forced = is_outline;
    for (int p = panels.begin; p < panels.end; ++p)
        for (const auto& edge : mesh.edge_vertices[p])
            for (size_t i = 0; i + 1 < edge.size(); ++i) {
                const int a = edge[i].vertex, b = edge[i + 1].vertex;
                const bool is_short = (mesh.uv[a] - mesh.uv[b]).norm() < kMinEdge * mesh.edge[p];
                is_outline[a] = is_outline[b] = true;
                is_forced[a] = is_forced[a] || is_short || angles[a] < kSharpCorner;
                is_forced[b] = is_forced[b] || is_short || angles[b] < kSharpCorner;
            }
    return {is_outline, is_forced};
}

void measure_edges(const PatternMesh& mesh, View<const Triangle> triangles, MeshQuality& quality)
{
    std::vector<std::array<int, 2>> edges;
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    int in_range = 0;
    double sum = 0.0;
    quality.shortest_edge = 1e300;
    for (const auto& [a, b] : edges) {
        const double length = (mesh.uv[a] - mesh.uv[b]).norm() / mesh.edge[mesh.panel_of_vertex(a)];
        sum += length;
        in_range += length >= kMinEdge && length <= kMaxEdge;
        quality.shortest_edge = std::min(quality.shortest_edge, length);
        quality.longest_edge = std::max(quality.longest_edge, length);
    }
    quality.mean_edge = sum / double(edges.size());
    quality.in_range = in_range / double(edges.size());
}

MeshQuality quality_of(const PatternMesh& mesh, const PanelRange& panels)
{
    const View<const Triangle> triangles = panels.triangles(mesh);
    MeshQuality quality;
    quality.vertices = mesh.first_vertex[panels.end] - mesh.first_vertex[panels.begin];
    quality.triangles = triangles.size();
    measure_edges(mesh, triangles, quality);

    const OutlineVertices outline = outline_vertices(mesh, panels);
    quality.smallest_angle = quality.smallest_free_angle = std::numbers::pi;
    for (int i = 0; i < triangles.size(); ++i) {
        const Triangle& t = triangles[i];
        const double angle = smallest_angle(mesh, t);
        if (angle < quality.smallest_angle) {
            quality.smallest_angle = angle;
            quality.smallest_angle_triangle = mesh.first_triangle[panels.begin] + i;
        }
        if (outline.force(t))
            ++quality.forced_triangles;
        else
            quality.smallest_free_angle = std::min(quality.smallest_free_angle, angle);
    }
    return quality;
}

} // namespace

MeshQuality quality_of(const PatternMesh& mesh)
{
    return quality_of(mesh, PanelRange{0, mesh.panel_count()});
}

MeshQuality quality_of_panel(const PatternMesh& mesh, int panel)
{
    return quality_of(mesh, PanelRange{panel, panel + 1});
}

} // namespace toile::garment
