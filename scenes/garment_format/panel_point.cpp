#include "scenes/garment_format/panel_point.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/number.h"
#include "garment/pattern/edge_curve.h"
#include "scenes/format/names.h"
#include "scenes/garment_format/copies.h"
#include "scenes/garment_format/edge_name.h"

namespace toile::garment_format {
namespace {

using garment::PanelPoint;
using garment::Pattern;
using scene_format::as_written;
using scene_format::Document;

/// Distance within which a point beyond the outline is on it [m].
constexpr double kOnOutline = 1e-3;

/// Chords of an edge on which points are tested.
constexpr int kChords = 64;

std::vector<Vec2> polygon_of(const garment::Panel& panel)
{
    std::vector<Vec2> polygon;
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const garment::EdgeCurve curve(panel, int(e));
        for (int i = 0; i < kChords; ++i)
            polygon.push_back(curve.at(double(i) / kChords));
    }
    return polygon;
}

double distance_to_side(const Vec2& a, const Vec2& b, const Vec2& x)
{
    const double s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (x - a - s * (b - a)).norm();
}

bool lies_on(const garment::Panel& panel, const Vec2& x)
{
    const std::vector<Vec2> polygon = polygon_of(panel);
    bool is_inside = false;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if (distance_to_side(a, b, x) < kOnOutline)
            return true;
        if ((a.y() > x.y()) != (b.y() > x.y()) &&
            x.x() < a.x() + (b.x() - a.x()) * (x.y() - a.y()) / (b.y() - a.y()))
            is_inside = !is_inside;
    }
    return is_inside;
}

std::string box_text(const garment::Panel& panel)
{
    Vec2 lower = panel.corners.front(), upper = lower;
    for (const Vec2& corner : polygon_of(panel)) {
        lower = lower.cwiseMin(corner);
        upper = upper.cwiseMax(corner);
    }
    return "x from " + short_text(lower.x()) + " to " + short_text(upper.x()) + " and y from " +
           short_text(lower.y()) + " to " + short_text(upper.y()) + " m";
}

/// @param name  PANEL[x,y]
PanelPoint point_in_plane(const Document& document, const std::string& key_path, const std::string& name,
                          const Pattern& pattern)
{
    const size_t bracket = name.find('['), comma = name.find(',', bracket);
    std::optional<double> x, y;
    if (name.back() == ']') {
        x = number_in(name.substr(bracket + 1, comma - bracket - 1));
        const size_t first = std::min(name.find_first_not_of(' ', comma + 1), name.size() - 1);
        y = number_in(name.substr(first, name.size() - 1 - first));
    }
    if (!x || !y)
        document.refuse(key_path, as_written(name) + " names no point of a panel; write PANEL[0.1,0.2], by " +
                                      "metres in its plane, or PANEL.EDGE[0.25]");
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    const std::string panel = name.substr(0, bracket);
    scene_format::require_known(document, key_path, "panel", panel, names);
    PanelPoint point{int(std::find(names.begin(), names.end(), panel) - names.begin()), Vec2(*x, *y)};
    if (!lies_on(pattern.panels[size_t(point.panel)], point.point))
        document.refuse(key_path, as_written(name) + " lies outside of the panel, which has " +
                                      box_text(pattern.panels[size_t(point.panel)]));
    return point;
}

} // namespace

PanelPoint panel_point_of(const Document& document, const std::string& key_path, const std::string& name,
                          const Pattern& pattern)
{
    const size_t bracket = name.find('[');
    if (bracket != std::string::npos && name.find(',', bracket) != std::string::npos)
        return point_in_plane(document, key_path, name, pattern);
    const EdgePoint on_edge = edge_point_of(document, key_path, name, pattern);
    const garment::EdgeCurve curve(pattern.panels[size_t(on_edge.panel)], on_edge.edge);
    return {on_edge.panel, curve.at(on_edge.fraction)};
}

std::optional<PanelPoint> on_copy(const PanelPoint& point, int k, const GarmentFile& file,
                                  const Pattern& pattern)
{
    const std::string& name = pattern.panels[size_t(point.panel)].name;
    const auto settings = file.panels.find(name);
    if (settings == file.panels.end() || k >= settings->second.copies)
        return std::nullopt;
    const std::vector<std::string> names = scene_format::names_of(pattern.panels);
    PanelPoint copy = point;
    copy.panel = int(std::find(names.begin(), names.end(), name_of_copy(name, k)) - names.begin());
    if (settings->second.mirror && k % 2 == 1)
        copy.point.x() = -copy.point.x();
    return copy;
}

} // namespace toile::garment_format
