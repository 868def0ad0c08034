#include "garment/pattern/mesh/outline_check.h"

#include <algorithm>
#include <numeric>
#include <string>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_2/Segment_2_Segment_2.h>

#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::garment {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Chords of a curved edge in the search for crossings.
constexpr int kCheckChords = 128;

/// Extent across over extent along below which a panel has no area [-].
constexpr double kFlat = 1e-6;

/// Length of an edge over the panel's extent below which it counts as zero [-].
constexpr double kNoLength = 1e-7;

Kernel::Point_2 point(const Vec2& x) { return {x.x(), x.y()}; }

std::string place_of(const Pattern& pattern, const Panel& panel)
{
    return pattern.source + ": panel \"" + panel.name + "\"";
}

void require_closed(const Pattern& pattern, const Panel& panel)
{
    const std::string place = place_of(pattern, panel);
    if (panel.edges.empty())
        throw InvalidInput(place + " has no edges; it needs a closed loop of them");
    const int corner_count = int(panel.corners.size());
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const PanelEdge& edge = panel.edges[e];
        for (const int corner : {edge.start, edge.end})
            if (corner < 0 || corner >= corner_count)
                throw InvalidInput(place + ", edge " + std::to_string(e) + ": corner " +
                                   std::to_string(corner) + " does not exist; the panel has " +
                                   std::to_string(corner_count));
        const size_t next = (e + 1) % panel.edges.size();
        if (edge.end != panel.edges[next].start)
            throw InvalidInput(place + " is open: edge " + std::to_string(e) + " ends in corner " +
                               std::to_string(edge.end) + ", but edge " + std::to_string(next) +
                               " starts in corner " + std::to_string(panel.edges[next].start) +
                               "; each edge has to end where the next starts");
    }
    for (size_t i = 0; i < panel.corners.size(); ++i)
        if (const Vec2& x = panel.corners[i]; !is_in_range(Vec3(x.x(), x.y(), 0.0)))
            throw InvalidInput(place + ", corner " + std::to_string(i) + ": (" + std::to_string(x.x()) +
                               ", " + std::to_string(x.y()) + ") m is out of range");
}

/// Points along the outline and the edge that each one's side belongs to.
struct SampledOutline {
    std::vector<Vec2> points;
    std::vector<int> edge;
};

SampledOutline sample(const Panel& panel, const std::vector<EdgeCurve>& curves)
{
    SampledOutline outline;
    for (size_t e = 0; e < curves.size(); ++e) {
        const auto* bezier = std::get_if<Bezier>(&panel.edges[e].curve);
        const int chords = bezier && bezier->controls.empty() ? 1 : kCheckChords;
        for (int i = 0; i < chords; ++i) {
            outline.points.push_back(curves[e].at(double(i) / chords));
            outline.edge.push_back(int(e));
        }
    }
    return outline;
}

/// Largest distance from a point to the farthest other: at least half of the extent.
struct Extent {
    double along = 0.0, across = 0.0; ///< [m]
};

Extent extent_of(const std::vector<Vec2>& points)
{
    Extent extent;
    Vec2 axis = Vec2::UnitX();
    for (const Vec2& x : points)
        if (const double distance = (x - points[0]).norm(); distance > extent.along) {
            extent.along = distance;
            axis = (x - points[0]) / distance;
        }
    for (const Vec2& x : points) {
        const Vec2 d = x - points[0];
        extent.across = std::max(extent.across, std::abs(axis.x() * d.y() - axis.y() * d.x()));
    }
    return extent;
}

void require_lengths(const Pattern& pattern, const Panel& panel, const std::vector<EdgeCurve>& curves,
                     const Extent& extent)
{
    for (size_t e = 0; e < curves.size(); ++e)
        if (!(curves[e].length() > kNoLength * extent.along))
            throw InvalidInput(place_of(pattern, panel) + ", edge " + std::to_string(e) + " has length " +
                               std::to_string(curves[e].length()) +
                               " m; leave it out or move its ends apart");
}

void require_simple(const Pattern& pattern, const Panel& panel, const SampledOutline& outline)
{
    const std::string place = place_of(pattern, panel);
    if (outline.points.size() < 3)
        throw InvalidInput(place + " has " + std::to_string(panel.edges.size()) +
                           " straight edges; it needs three, or a curve");
    const auto crossing = find_crossing(outline.points);
    if (!crossing)
        return;
    const Vec2& x = outline.points[(*crossing)[1]];
    const int a = outline.edge[(*crossing)[0]], b = outline.edge[(*crossing)[1]];
    const std::string edges =
        a == b ? "edge " + std::to_string(a) + " crosses or touches itself"
               : "edges " + std::to_string(a) + " and " + std::to_string(b) + " cross or touch each other";
    throw InvalidInput(place + ": " + edges + " near (" + std::to_string(x.x()) + ", " +
                       std::to_string(x.y()) + ") m; an outline may not meet itself");
}

std::vector<EdgeCurve> curves_of(const Pattern& pattern, const Panel& panel)
{
    require_closed(pattern, panel);
    std::vector<EdgeCurve> curves;
    try {
        for (size_t e = 0; e < panel.edges.size(); ++e)
            curves.emplace_back(panel, int(e));
    } catch (const InvalidInput& error) {
        throw InvalidInput(pattern.source + ": " + error.what());
    }
    const SampledOutline outline = sample(panel, curves);
    const Extent extent = extent_of(outline.points);
    require_lengths(pattern, panel, curves, extent);
    if (!(extent.across > kFlat * extent.along))
        throw InvalidInput(place_of(pattern, panel) + " has no area: all of it lies on one line of " +
                           std::to_string(extent.along) + " m");
    require_simple(pattern, panel, outline);
    return curves;
}

using Edges = std::vector<std::array<int, 2>>;

/// Edge and its range along the direction of the sweep.
struct Range {
    int edge = 0;
    double low = 0.0, high = 0.0;
};

/// Edges in ascending order along a direction that no pattern is aligned with, so that few overlap.
std::vector<Range> sorted_ranges(const std::vector<Vec2>& points, const Edges& edges)
{
    const Vec2 direction(0.8253, 0.5647);
    std::vector<Range> ranges;
    for (size_t i = 0; i < edges.size(); ++i) {
        const double a = direction.dot(points[edges[i][0]]), b = direction.dot(points[edges[i][1]]);
        const double rounding = 1e-12 * (std::abs(a) + std::abs(b));
        ranges.push_back({int(i), std::min(a, b) - rounding, std::max(a, b) + rounding});
    }
    std::stable_sort(ranges.begin(), ranges.end(),
                     [](const Range& a, const Range& b) { return a.low < b.low; });
    return ranges;
}

/// True if two edges, which meet in `middle`, lie on each other.
bool folds_back(const Vec2& before, const Vec2& middle, const Vec2& after)
{
    return (before - middle).dot(after - middle) > 0.0 &&
           CGAL::collinear(point(before), point(middle), point(after));
}

bool edges_meet(const std::vector<Vec2>& points, const std::array<int, 2>& a, const std::array<int, 2>& b)
{
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 2; ++k)
            if (a[i] == b[k])
                return folds_back(points[a[1 - i]], points[a[i]], points[b[1 - k]]);
    return CGAL::do_intersect(Kernel::Segment_2(point(points[a[0]]), point(points[a[1]])),
                              Kernel::Segment_2(point(points[b[0]]), point(points[b[1]])));
}

} // namespace

PatternCurves outline_curves(const Pattern& pattern)
{
    if (pattern.panels.empty())
        throw InvalidInput(pattern.source + " has no panels; a pattern needs one at least");
    PatternCurves curves;
    for (const Panel& panel : pattern.panels)
        curves.push_back(curves_of(pattern, panel));
    return curves;
}

std::optional<std::array<int, 2>> find_crossing(const std::vector<Vec2>& corners)
{
    Edges sides;
    for (int i = 0; i < int(corners.size()); ++i)
        sides.push_back({i, (i + 1) % int(corners.size())});
    return find_crossing(corners, sides);
}

std::optional<std::array<int, 2>> find_crossing(const std::vector<Vec2>& points, const Edges& edges)
{
    const std::vector<Range> ranges = sorted_ranges(points, edges);
    for (size_t i = 0; i < ranges.size(); ++i)
        for (size_t k = i + 1; k < ranges.size() && ranges[k].low <= ranges[i].high; ++k)
            if (const int a = ranges[i].edge, b = ranges[k].edge; edges_meet(points, edges[a], edges[b]))
                return std::array{std::min(a, b), std::max(a, b)};
    return std::nullopt;
}

} // namespace toile::garment
