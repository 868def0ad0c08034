#include "garment/pattern/mesh/pattern_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "core/base/error.h"
#include "garment/pattern/mesh/inner_lines.h"
#include "garment/pattern/mesh/outline_points.h"
#include "garment/pattern/mesh/panel_fill.h"
#include "garment/pattern/mesh/sewn_mesh.h"

namespace toile::garment {

namespace {

/// Outline of a panel as a polygon, from the start of edge 0 along the loop. [m]
std::vector<Vec2> polygon_of(const std::vector<EdgeCurve>& curves,
                             const std::vector<std::vector<double>>& fractions)
{
    std::vector<Vec2> polygon;
    for (size_t e = 0; e < curves.size(); ++e)
        for (size_t i = 0; i + 1 < fractions[e].size(); ++i)
            polygon.push_back(curves[e].at(fractions[e][i]));
    return polygon;
}

double polygon_area(const std::vector<Vec2>& polygon)
{
    double twice = 0.0;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x() * b.y() - a.y() * b.x();
    }
    return 0.5 * twice;
}

struct PanelSize {
    double area = 0.0;    ///< [m^2] signed as its loop runs
    double outline = 0.0; ///< [m]
};

std::vector<PanelSize> sizes_of(const Pattern& pattern, const PatternCurves& curves)
{
    std::vector<PanelSize> sizes;
    for (size_t p = 0; p < curves.size(); ++p) {
        sizes.push_back({signed_area(pattern.panels[p]), 0.0});
        for (const EdgeCurve& curve : curves[p])
            sizes.back().outline += curve.length();
    }
    return sizes;
}

/// Target that a narrow panel needs: edges of at most one and a half times its width. A sliver gets no more
/// than a thousand points along its outline for that.
double narrow_target(const PanelSize& size)
{
    return std::max(3.0 * std::abs(size.area) / size.outline, 1e-3 * size.outline);
}

std::vector<double> targets_of(const Pattern& pattern, const PatternMeshSettings& settings,
                               const std::vector<PanelSize>& sizes)
{
    std::vector<double> targets;
    if (!settings.panel_edges.empty() && settings.panel_edges.size() != sizes.size())
        throw InvalidInput(pattern.source + ": " + std::to_string(settings.panel_edges.size()) +
                           " targets of edge lengths for " + std::to_string(sizes.size()) +
                           " panels; give one for each");
    for (size_t p = 0; p < sizes.size(); ++p) {
        const double edge = settings.panel_edges.empty() ? settings.edge : settings.panel_edges[p];
        if (!(edge > 0.0) || !std::isfinite(edge))
            throw InvalidInput(pattern.source + ": panel \"" + pattern.panels[p].name + "\": edge length " +
                               std::to_string(edge) + " m; it must be positive");
        targets.push_back(std::min(edge, narrow_target(sizes[p])));
    }
    return targets;
}

std::string short_number(double value)
{
    char text[32];
    std::snprintf(text, sizeof(text), "%.2g", value);
    return text;
}

/// @throws InvalidInput if the meshes would have more than kMaxPatternVertices
void require_affordable(const Pattern& pattern, const std::vector<PanelSize>& sizes,
                        const std::vector<double>& targets)
{
    double count = 0.0, finest = targets.empty() ? 0.0 : targets[0];
    for (size_t p = 0; p < sizes.size(); ++p) {
        const double equilateral = std::sqrt(0.75) * targets[p] * targets[p];
        count += std::abs(sizes[p].area) / equilateral + 0.5 * sizes[p].outline / targets[p];
        finest = std::min(finest, targets[p]);
    }
    if (count > kMaxPatternVertices)
        throw InvalidInput(pattern.source + ": edges of " + short_number(finest) + " m would give " +
                           short_number(count) + " vertices, at most " + short_number(kMaxPatternVertices) +
                           " may be; use " +
                           short_number(1.1 * finest * std::sqrt(count / kMaxPatternVertices)) +
                           " m, or check the pattern's unit");
}

/// True if the points along the outline still form a simple polygon with its orientation.
bool is_good_polygon(const std::vector<Vec2>& polygon, double area)
{
    return polygon.size() >= 3 && polygon_area(polygon) * area > 0.0 && !find_crossing(polygon);
}

/// Points on the outlines and lines, with smaller targets for panels whose curves need them to stay simple.
OutlinePoints divide_until_simple(const Pattern& pattern, const PatternCurves& curves,
                                  const std::vector<PanelSize>& sizes, OutlineTargets& targets)
{
    constexpr int kHalvings = 8;
    for (int i = 0;; ++i) {
        require_affordable(pattern, sizes, targets.edge);
        OutlinePoints points = divide_outlines(pattern, with_lines(pattern, curves), targets);
        bool is_simple = true;
        for (size_t p = 0; p < curves.size(); ++p) {
            if (is_good_polygon(polygon_of(curves[p], points.fractions[p]), sizes[p].area))
                continue;
            if (i == kHalvings)
                throw InvalidInput(pattern.source + ": panel \"" + pattern.panels[p].name +
                                   "\" is too thin to mesh, even with edges of " +
                                   short_number(targets.edge[p]) + " m; its edges almost touch");
            is_simple = false;
            targets.edge[p] *= 0.5;
        }
        if (is_simple)
            return points;
    }
}

/// Mesh of one panel. Loops that run clockwise are filled in a mirror.
struct PanelMesher {
    PanelFill fill;
    bool is_mirrored;

    static PanelMesher of(PanelFrame frame, double area, double target)
    {
        if (area < 0.0)
            for (Vec2& x : frame.points)
                x.x() = -x.x();
        return {PanelFill(frame, target), area < 0.0};
    }

    void append_to(PatternMesh& mesh) const
    {
        const int first = mesh.vertex_count();
        for (const Vec2& x : fill.vertices())
            mesh.uv.emplace_back(is_mirrored ? -x.x() : x.x(), x.y());
        for (const Triangle& t : fill.triangles())
            mesh.triangles.push_back(t + Triangle::Constant(first));
        mesh.first_vertex.push_back(mesh.vertex_count());
        mesh.first_triangle.push_back(mesh.triangle_count());
    }
};

/// Numbers the points along a panel's edges; its last point is its first.
std::vector<std::vector<EdgeVertex>> number_edges(const std::vector<std::vector<double>>& fractions,
                                                  int first)
{
    int count = 0;
    for (const auto& edge : fractions)
        count += int(edge.size()) - 1;
    std::vector<std::vector<EdgeVertex>> edges;
    int next = 0;
    for (const auto& edge : fractions) {
        edges.emplace_back();
        for (size_t i = 0; i < edge.size(); ++i)
            edges.back().push_back({first + (next + int(i)) % count, edge[i]});
        next += int(edge.size()) - 1;
    }
    return edges;
}

std::vector<std::array<int, 2>> stitches_of(const std::vector<std::array<OutlinePoint, 2>>& seam,
                                            const PatternMesh& mesh)
{
    const auto vertex = [&](const OutlinePoint& at) {
        return mesh.vertices_along(at.panel, at.edge)[size_t(at.point)].vertex;
    };
    std::vector<std::array<int, 2>> pairs;
    for (const auto& [a, b] : seam)
        if (vertex(a) != vertex(b))
            pairs.push_back({vertex(a), vertex(b)});
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Vertices along the lines of a panel.
/// @param lines  [lines] their points
/// @param first  vertex of the panel
std::vector<std::vector<EdgeVertex>> number_lines(const std::vector<std::vector<double>>& fractions,
                                                  const std::vector<std::vector<int>>& lines, int first)
{
    std::vector<std::vector<EdgeVertex>> result;
    for (size_t l = 0; l < fractions.size(); ++l) {
        result.emplace_back();
        for (size_t i = 0; i < fractions[l].size(); ++i)
            result.back().push_back({first + lines[l][i], fractions[l][i]});
    }
    return result;
}

PatternMesh assemble(const std::vector<PanelMesher>& panels, const std::vector<LinedFrame>& frames,
                     const std::vector<int>& first_lines, const OutlinePoints& points,
                     const std::vector<double>& targets)
{
    PatternMesh mesh;
    mesh.first_vertex = {0};
    mesh.first_triangle = {0};
    mesh.edge = targets;
    for (size_t p = 0; p < panels.size(); ++p) {
        mesh.edge_vertices.push_back(number_edges(points.fractions[p], mesh.vertex_count()));
        mesh.panel_lines.push_back(number_lines(
            points.line_fractions[p],
            {frames[p].lines.begin() + first_lines[p],
             frames[p].lines.begin() + first_lines[p] + std::ptrdiff_t(points.line_fractions[p].size())},
            mesh.vertex_count()));
        panels[p].append_to(mesh);
    }
    for (const auto& seam : points.seams)
        mesh.stitches.push_back(stitches_of(seam, mesh));
    return mesh;
}

/// Pattern mesh of the outlines and lines alone, for welding.
PatternMesh outlines_of(const OutlinePoints& points)
{
    PatternMesh mesh;
    mesh.first_vertex = {0};
    for (const auto& panel : points.fractions) {
        mesh.edge_vertices.push_back(number_edges(panel, mesh.vertex_count()));
        for (const auto& edge : panel)
            mesh.uv.resize(mesh.uv.size() + edge.size() - 1, Vec2::Zero());
        mesh.panel_lines.emplace_back();
        for (const auto& line : points.line_fractions[mesh.first_vertex.size() - 1]) {
            mesh.panel_lines.back().emplace_back();
            for (const double fraction : line) {
                mesh.panel_lines.back().back().push_back({mesh.vertex_count(), fraction});
                mesh.uv.push_back(Vec2::Zero());
            }
        }
        mesh.first_vertex.push_back(mesh.vertex_count());
    }
    for (const auto& seam : points.seams)
        mesh.stitches.push_back(stitches_of(seam, mesh));
    return mesh;
}

/// Numbers of the intervals on each edge that are sewn. [panels][edges]
std::vector<std::vector<std::set<int>>> sewn_intervals(const OutlinePoints& points)
{
    std::vector<std::vector<std::set<int>>> result;
    for (const auto& panel : points.fractions)
        result.emplace_back(panel.size());
    for (const auto& seam : points.seams)
        for (size_t i = 0; i + 1 < seam.size(); ++i)
            for (int side = 0; side < 2; ++side) {
                const OutlinePoint &low = seam[i][side], &high = seam[i + 1][side];
                if (size_t(low.edge) >= result[low.panel].size())
                    continue; // a line
                if (low.panel == high.panel && low.edge == high.edge && std::abs(low.point - high.point) == 1)
                    result[low.panel][low.edge].insert(std::min(low.point, high.point));
            }
    return result;
}

/// Asks for one more interval where a free side of a panel has both ends in common with another, once the
/// pattern is sewn: the opening there, as of a narrow strap, would close.
/// @return true if there is such a side
bool divide_closing_edges(const OutlinePoints& points, OutlineTargets& targets)
{
    const PatternMesh outlines = outlines_of(points);
    const std::vector<int> welded = weld_stitches(outlines);
    const auto sewn = sewn_intervals(points);
    struct Side {
        std::array<int, 2> ends;
        int panel, edge;
        bool is_free;
    };
    std::vector<Side> sides;
    std::map<std::array<int, 2>, int> count;
    for (int p = 0; p < int(sewn.size()); ++p)
        for (int e = 0; e < int(sewn[p].size()); ++e)
            for (int i = 0; i + 1 < int(points.fractions[p][e].size()); ++i) {
                const auto& vertices = outlines.edge_vertices[p][e];
                const int a = welded[vertices[i].vertex], b = welded[vertices[i + 1].vertex];
                sides.push_back({{std::min(a, b), std::max(a, b)}, p, e, !sewn[p][e].contains(i)});
                ++count[sides.back().ends];
            }
    std::set<std::array<int, 2>> closing;
    for (const Side& side : sides)
        if (side.is_free && (count[side.ends] > 1 || side.ends[0] == side.ends[1]))
            closing.insert({side.panel, side.edge});
    for (const auto& [p, e] : closing)
        ++targets.free_intervals[p][e];
    return !closing.empty();
}

std::vector<std::vector<int>> line_vertices_of(const PatternMesh& mesh, const std::vector<InnerLine>& lines,
                                               const std::vector<LinedFrame>& frames)
{
    std::vector<std::vector<int>> result;
    for (size_t l = 0; l < lines.size(); ++l) {
        result.push_back(frames[lines[l].panel].lines[l]);
        for (int& vertex : result.back())
            vertex += mesh.first_vertex[lines[l].panel];
    }
    return result;
}

/// Lines that edges of the mesh follow: those of the settings, then the pattern's folds, then those of
/// panels.
std::vector<InnerLine> lines_of(const Pattern& pattern, const PatternMeshSettings& settings)
{
    std::vector<InnerLine> lines = settings.lines;
    for (const PanelFold& fold : pattern.folds)
        lines.push_back({fold.panel, fold.points, fold.name});
    for (int p = 0; p < int(pattern.panels.size()); ++p)
        for (const PanelLine& line : pattern.panels[p].lines)
            lines.push_back({p, line.points, line.name});
    return lines;
}

/// Index of the first line of each panel in lines_of(). [panels]
std::vector<int> first_lines_of(const Pattern& pattern, const PatternMeshSettings& settings)
{
    std::vector<int> first;
    int next = int(settings.lines.size() + pattern.folds.size());
    for (const Panel& panel : pattern.panels) {
        first.push_back(next);
        next += int(panel.lines.size());
    }
    return first;
}

/// Points along the lines of panels. [lines_of()] empty for others [m]
std::vector<std::vector<Vec2>> divided_lines(const PatternCurves& curves, const OutlinePoints& points,
                                             size_t line_count, const std::vector<int>& first_lines)
{
    std::vector<std::vector<Vec2>> divided(line_count);
    for (size_t p = 0; p < curves.size(); ++p)
        for (size_t l = 0; l < points.line_fractions[p].size(); ++l)
            for (const double fraction : points.line_fractions[p][l])
                divided[size_t(first_lines[p]) + l].push_back(
                    curves[p][points.fractions[p].size() + l].at(fraction));
    return divided;
}

/// [seams] whether it is on a line inside of a panel
std::vector<bool> inner_seams(const Pattern& pattern)
{
    std::vector<bool> inner;
    const auto on_line = [&](const EdgePart& part) { return is_on_line(pattern, part); };
    for (const Seam& seam : pattern.seams)
        inner.push_back(std::any_of(seam.a.begin(), seam.a.end(), on_line) ||
                        std::any_of(seam.b.begin(), seam.b.end(), on_line));
    return inner;
}

/// Splits edges, given by vertices of the mesh, in their panels.
void split_edges(const std::vector<std::array<int, 2>>& edges, const PatternMesh& mesh,
                 std::vector<PanelMesher>& panels)
{
    std::vector<std::vector<std::array<int, 2>>> of_panel(panels.size());
    for (const auto& [a, b] : edges) {
        const int p = mesh.panel_of_vertex(a);
        of_panel[p].push_back({a - mesh.first_vertex[p], b - mesh.first_vertex[p]});
    }
    for (size_t p = 0; p < panels.size(); ++p)
        if (!of_panel[p].empty())
            panels[p].fill.split(of_panel[p]);
}

int owner(const std::vector<int>& first, int item)
{
    return int(std::upper_bound(first.begin(), first.end(), item) - first.begin()) - 1;
}

} // namespace

int PatternMesh::panel_of_vertex(int vertex) const { return owner(first_vertex, vertex); }
int PatternMesh::panel_of_triangle(int triangle) const { return owner(first_triangle, triangle); }

namespace {

/// Lines and outlines that nearly touch leave triangles without height between them.
void require_height(const Pattern& pattern, const PatternMesh& mesh)
{
    constexpr double kLeastHeight = 1e-5; // of the longest edge
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& corner = mesh.triangles[size_t(t)];
        const Vec2 &a = mesh.uv[size_t(corner[0])], &b = mesh.uv[size_t(corner[1])],
                   &c = mesh.uv[size_t(corner[2])];
        const Vec2 ab = b - a, ac = c - a;
        const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
        if (std::abs(ab.x() * ac.y() - ab.y() * ac.x()) > kLeastHeight * longest)
            continue;
        char place[64];
        std::snprintf(place, sizeof place, "(%.4g, %.4g) m", a.x(), a.y());
        throw InvalidInput(pattern.source + ": panel \"" +
                           pattern.panels[size_t(mesh.panel_of_triangle(t))].name +
                           "\": lines or edges touch near " + place +
                           " but do not meet in a point; move them apart, or let both end there");
    }
}

} // namespace

PatternMesh mesh_pattern(const Pattern& pattern, const PatternMeshSettings& settings)
{
    const PatternCurves curves = outline_curves(pattern);
    const std::vector<PanelSize> sizes = sizes_of(pattern, curves);
    OutlineTargets targets{targets_of(pattern, settings, sizes), {}, {}};
    const std::vector<InnerLine> lines = lines_of(pattern, settings);
    const std::vector<LineEnds> line_ends = place_lines(pattern, curves, lines);
    const std::vector<int> first_lines = first_lines_of(pattern, settings);
    const PatternCurves lined = with_lines(pattern, curves);
    targets.marks = marks_of(pattern, curves, lines, line_ends);
    for (size_t p = 0; p < lined.size(); ++p) {
        targets.free_intervals.emplace_back(lined[p].size(), 1);
        for (size_t e = curves[p].size(); e < lined[p].size(); ++e)
            targets.marks[p].push_back(lined[p][e].corner_fractions());
    }

    OutlinePoints points = divide_until_simple(pattern, curves, sizes, targets);
    while (divide_closing_edges(points, targets))
        points = divide_until_simple(pattern, curves, sizes, targets);

    const std::vector<std::vector<Vec2>> divided = divided_lines(lined, points, lines.size(), first_lines);
    std::vector<PanelMesher> panels;
    std::vector<LinedFrame> frames;
    for (int p = 0; p < int(curves.size()); ++p) {
        frames.push_back(lined_frame(pattern, p, polygon_of(curves[p], points.fractions[p]),
                                     points.fractions[p], lines, line_ends, divided, targets.edge[p]));
        panels.push_back(PanelMesher::of(frames[p].frame, sizes[p].area, targets.edge[p]));
    }

    // An edge inside of one panel may have the ends of an edge of another, across a corner that both share.
    constexpr int kMaxRounds = 10;
    PatternMesh mesh = assemble(panels, frames, first_lines, points, targets.edge);
    for (int round = 0; round < kMaxRounds; ++round) {
        const auto edges = edges_to_split(mesh);
        if (edges.empty())
            break;
        split_edges(edges, mesh, panels);
        mesh = assemble(panels, frames, first_lines, points, targets.edge);
    }
    require_height(pattern, mesh);
    mesh.is_inner_seam = inner_seams(pattern);
    mesh.line_vertices = line_vertices_of(mesh, lines, frames);
    const auto first_fold = mesh.line_vertices.begin() + std::ptrdiff_t(settings.lines.size());
    mesh.fold_vertices.assign(first_fold, first_fold + std::ptrdiff_t(pattern.folds.size()));
    mesh.line_vertices.erase(first_fold, mesh.line_vertices.end());
    return mesh;
}

} // namespace toile::garment
