#include "garment/pattern/mesh/inner_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace toile::garment {

namespace {

/// Distance over the outline's length within which a line's end is on the outline [-].
constexpr double kOnOutline = 1e-3;

std::string place_of(const Pattern& pattern, const InnerLine& line)
{
    return pattern.source + ": panel \"" + pattern.panels[line.panel].name + "\", line \"" + line.name + "\"";
}

struct NearestOnEdge {
    double distance = 1e300; ///< [m]
    double fraction = 0.0;   ///< [-]
};

/// Point of a curve nearest to x, by samples and a search between the two beside the best.
NearestOnEdge nearest_on(const EdgeCurve& curve, const Vec2& x)
{
    constexpr int kSamples = 256, kBisections = 60;
    const auto distance = [&](double fraction) { return (curve.at(fraction) - x).norm(); };
    NearestOnEdge best;
    for (int i = 0; i <= kSamples; ++i)
        if (const double d = distance(double(i) / kSamples); d < best.distance)
            best = {d, double(i) / kSamples};
    double low = std::max(0.0, best.fraction - 1.0 / kSamples);
    double high = std::min(1.0, best.fraction + 1.0 / kSamples);
    for (int i = 0; i < kBisections; ++i) {
        const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
        (distance(a) < distance(b) ? high : low) = distance(a) < distance(b) ? b : a;
    }
    const double middle = 0.5 * (low + high);
    return distance(middle) < best.distance ? NearestOnEdge{distance(middle), middle} : best;
}

/// A fraction near the end of an edge is that end: a corner.
double snapped(double fraction)
{
    if (fraction < kSameCorner)
        return 0.0;
    return fraction > 1.0 - kSameCorner ? 1.0 : fraction;
}

/// Sorts fractions of an edge, and keeps one of those that are the same point.
void sort_apart(std::vector<double>& fractions)
{
    std::sort(fractions.begin(), fractions.end());
    fractions.erase(std::unique(fractions.begin(), fractions.end(),
                                [](double a, double b) { return b - a < kSameCorner; }),
                    fractions.end());
}

double length_of(const std::vector<EdgeCurve>& curves)
{
    double length = 0.0;
    for (const EdgeCurve& curve : curves)
        length += curve.length();
    return length;
}

/// No side of a line inside a panel is longer than its outline.
void require_plausible(const Pattern& pattern, const InnerLine& line, double outline)
{
    if (line.points.size() < 2)
        throw InvalidInput(place_of(pattern, line) + " has " + std::to_string(line.points.size()) +
                           " points; it needs two or more");
    for (size_t i = 0; i + 1 < line.points.size(); ++i) {
        const double length = (line.points[i + 1] - line.points[i]).norm();
        if (length <= kSameCorner * outline)
            throw InvalidInput(place_of(pattern, line) + ": points " + std::to_string(i) + " and " +
                               std::to_string(i + 1) + " are the same; remove one of them");
        if (!(length < outline))
            throw InvalidInput(place_of(pattern, line) + ": " + std::to_string(length) + " m from point " +
                               std::to_string(i) + " to the next; the whole outline has " +
                               std::to_string(outline) + " m");
    }
}

std::optional<LineEnd> end_on_outline(const std::vector<EdgeCurve>& curves, const Vec2& x)
{
    NearestOnEdge best;
    int edge = 0;
    for (int e = 0; e < int(curves.size()); ++e)
        if (const NearestOnEdge nearest = nearest_on(curves[e], x); nearest.distance < best.distance) {
            best = nearest;
            edge = e;
        }
    if (best.distance > kOnOutline * length_of(curves))
        return std::nullopt;
    return LineEnd{edge, snapped(best.fraction)};
}

/// Number of an outline's point by its fraction on an edge.
int outline_point(const std::vector<std::vector<double>>& fractions, const LineEnd& end)
{
    int first = 0, count = 0;
    for (int e = 0; e < int(fractions.size()); ++e) {
        count += int(fractions[e].size()) - 1;
        first += e < end.edge ? int(fractions[e].size()) - 1 : 0;
    }
    const std::vector<double>& edge = fractions[end.edge];
    const auto is_nearer = [&](double a, double b) {
        return std::abs(a - end.fraction) < std::abs(b - end.fraction);
    };
    return (first + int(std::min_element(edge.begin(), edge.end(), is_nearer) - edge.begin())) % count;
}

/// Corners of a line with its ends moved onto the outline's points.
std::vector<Vec2> corners_of(const InnerLine& line, const LineEnds& ends,
                             const std::array<int, 2>& end_points, const std::vector<Vec2>& polygon)
{
    std::vector<Vec2> corners = line.points;
    if (ends[0])
        corners.front() = polygon[end_points[0]];
    if (ends[1])
        corners.back() = polygon[end_points[1]];
    return corners;
}

/// Points along a line from corner to corner. One that goes from outline to outline gets a point between them
/// at least.
std::vector<Vec2> divide(const std::vector<Vec2>& corners, double target)
{
    std::vector<Vec2> points{corners.front()};
    const int least = corners.size() == 2 ? 2 : 1;
    for (size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vec2 &a = corners[i], &b = corners[i + 1];
        const int count = std::max(least, int(std::ceil((b - a).norm() / target)));
        for (int k = 1; k < count; ++k)
            points.push_back(a + (b - a) * k / count);
        points.push_back(b);
    }
    return points;
}

/// Adds a line's points to a frame.
/// @param divided  points along it; empty: by the target
std::vector<int> add_line(const InnerLine& line, const LineEnds& ends,
                          const std::vector<std::vector<double>>& fractions, std::vector<Vec2> divided,
                          double target, PanelFrame& frame)
{
    const std::array end_points{ends[0] ? outline_point(fractions, *ends[0]) : -1,
                                ends[1] ? outline_point(fractions, *ends[1]) : -1};
    const std::vector<Vec2> corners = corners_of(line, ends, end_points, frame.points);
    if (divided.empty())
        divided = divide(corners, target);
    const bool is_closed = !ends[0] && corners.front() == corners.back();
    const auto add_point = [&](const Vec2& x) {
        frame.points.push_back(x);
        return int(frame.points.size()) - 1;
    };

    std::vector<int> result{ends[0] ? end_points[0] : add_point(corners.front())};
    for (size_t i = 1; i + 1 < divided.size(); ++i)
        result.push_back(add_point(divided[i]));
    if (ends[1])
        result.push_back(end_points[1]);
    else
        result.push_back(is_closed ? result.front() : add_point(corners.back()));
    for (size_t i = 0; i + 1 < result.size(); ++i)
        frame.inner_edges.push_back({result[i], result[i + 1]});
    return result;
}

/// Points of closures and attachments of a pattern.
std::vector<PanelPoint> points_of(const Pattern& pattern)
{
    std::vector<PanelPoint> points;
    for (const Closure& closure : pattern.closures)
        points.insert(points.end(), {closure.a, closure.b});
    for (const BodyAttachment& attachment : pattern.attachments)
        points.insert(points.end(), attachment.points.begin(), attachment.points.end());
    return points;
}

/// Distance of a point from the edges and points of a frame [m].
double distance_to(const PanelFrame& frame, const Vec2& x)
{
    double nearest = std::numeric_limits<double>::infinity();
    for (const Vec2& point : frame.points)
        nearest = std::min(nearest, (point - x).norm());
    for (const auto& [i, k] : edges_of(frame)) {
        const Vec2 a = frame.points[i], ab = frame.points[k] - a;
        const double t = std::clamp((x - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (x - a - t * ab).norm());
    }
    return nearest;
}

void add_points(const Pattern& pattern, int panel, double target, PanelFrame& frame)
{
    constexpr double kMinDistance = 0.5; // over the target
    constexpr double kBeyond = 1e-3;     // [m] by which a point may lie outside of the outline
    for (const PanelPoint& point : points_of(pattern))
        if (point.panel == panel &&
            distance_to(frame, point.point) > std::max(kMinDistance * target, kBeyond))
            frame.points.push_back(point.point);
}

bool is_inside(const std::vector<Vec2>& polygon, const Vec2& x)
{
    bool inside = false;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a.y() > x.y()) != (b.y() > x.y()) &&
            x.x() < a.x() + (b.x() - a.x()) * (x.y() - a.y()) / (b.y() - a.y()))
            inside = !inside;
    }
    return inside;
}

/// Line that an edge of a frame belongs to, or -1 for the outline.
int line_of_edge(const LinedFrame& lined, const std::array<int, 2>& edge)
{
    for (int l = 0; l < int(lined.lines.size()); ++l)
        for (size_t i = 0; i + 1 < lined.lines[l].size(); ++i)
            if (lined.lines[l][i] == edge[0] && lined.lines[l][i + 1] == edge[1])
                return l;
    return -1;
}

void require_no_crossing(const Pattern& pattern, const std::vector<InnerLine>& lines, const LinedFrame& lined)
{
    const std::vector<std::array<int, 2>> edges = edges_of(lined.frame);
    const auto crossing = find_crossing(lined.frame.points, edges);
    if (!crossing)
        return;
    int a = line_of_edge(lined, edges[(*crossing)[0]]), b = line_of_edge(lined, edges[(*crossing)[1]]);
    if (a < 0)
        std::swap(a, b);
    const std::string other = b < 0 ? "the outline" : a == b ? "itself" : "line \"" + lines[b].name + "\"";
    throw InvalidInput(place_of(pattern, lines[a]) + " crosses or touches " + other +
                       "; lines may meet the outline with their ends only");
}

} // namespace

std::vector<LineEnds> place_lines(const Pattern& pattern, const PatternCurves& curves,
                                  const std::vector<InnerLine>& lines)
{
    std::vector<LineEnds> result;
    for (const InnerLine& line : lines) {
        if (line.panel < 0 || line.panel >= int(curves.size()))
            throw InvalidInput(pattern.source + ": line \"" + line.name + "\": panel " +
                               std::to_string(line.panel) + " does not exist; the pattern has " +
                               std::to_string(curves.size()));
        require_plausible(pattern, line, length_of(curves[line.panel]));
        LineEnds ends;
        if (line.points.front() != line.points.back())
            ends = {end_on_outline(curves[line.panel], line.points.front()),
                    end_on_outline(curves[line.panel], line.points.back())};
        result.push_back(ends);
    }
    return result;
}

std::vector<std::vector<std::vector<double>>> marks_of(const Pattern& pattern, const PatternCurves& curves,
                                                       const std::vector<InnerLine>& lines,
                                                       const std::vector<LineEnds>& ends)
{
    std::vector<std::vector<std::vector<double>>> marks;
    for (const auto& panel : curves)
        marks.emplace_back(panel.size());
    const auto mark = [&](int panel, const std::optional<LineEnd>& end) {
        if (end && end->fraction > 0.0 && end->fraction < 1.0)
            marks[panel][end->edge].push_back(end->fraction);
    };
    for (size_t l = 0; l < lines.size(); ++l)
        for (const auto& end : ends[l])
            mark(lines[l].panel, end);
    for (const PanelPoint& point : points_of(pattern))
        mark(point.panel, end_on_outline(curves[point.panel], point.point));
    for (auto& panel : marks)
        for (auto& edge : panel)
            sort_apart(edge);
    return marks;
}

LinedFrame lined_frame(const Pattern& pattern, int panel, const std::vector<Vec2>& polygon,
                       const std::vector<std::vector<double>>& fractions, const std::vector<InnerLine>& lines,
                       const std::vector<LineEnds>& ends, const std::vector<std::vector<Vec2>>& divided,
                       double target)
{
    LinedFrame result;
    result.frame.points = polygon;
    result.frame.outline_count = int(polygon.size());
    result.lines.resize(lines.size());
    for (size_t l = 0; l < lines.size(); ++l)
        if (lines[l].panel == panel)
            result.lines[l] = add_line(lines[l], ends[l], fractions, divided[l], target, result.frame);
    add_points(pattern, panel, target, result.frame);
    if (result.frame.inner_edges.empty())
        return result;
    require_no_crossing(pattern, lines, result);
    for (size_t l = 0; l < lines.size(); ++l)
        if (!result.lines[l].empty() && !is_inside(polygon, result.frame.points[result.lines[l][1]]))
            throw InvalidInput(place_of(pattern, lines[l]) + " lies outside of its panel");
    return result;
}

} // namespace toile::garment
