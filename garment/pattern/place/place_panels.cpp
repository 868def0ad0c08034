#include "garment/pattern/place/place_panels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "core/base/error.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/place/girth_curve.h"

namespace toile::garment {

namespace {

/// Directions in a panel's plane: along the segment, and to the right of who looks at the outer side.
struct PanelAxes {
    Vec2 along = Vec2::UnitY();
    Vec2 right = Vec2::UnitX();
};

/// Direction along a segment, half as the body holds it, half as patterns are drafted: for arms in A-pose.
Vec3 drafted_axis(BodySegment at, const ArrangementSegments& body)
{
    const Vec3 axis = body[size_t(at)].axis();
    if (at != BodySegment::LeftArm && at != BodySegment::RightArm)
        return axis;
    const AxisSegment& torso = body[size_t(BodySegment::Torso)];
    const Vec3 inwards = at == BodySegment::LeftArm ? Vec3(-torso.left()) : torso.left();
    return axis + (torso.axis() + inwards).normalized();
}

PanelAxes axes_of(const Panel& panel, const ArrangementSegments& body)
{
    PanelAxes axes;
    if (!panel.placement.isApprox(Eigen::Isometry3d::Identity())) {
        const Vec3 local = panel.placement.linear().transpose() * drafted_axis(panel.place->at, body);
        // An upright panel beside an arm in A-pose was meant upright.
        constexpr double kLying = 1.2; // [-]
        if (std::abs(local.x()) > kLying * std::abs(local.y()))
            axes.along = Vec2(std::copysign(1.0, local.x()), 0.0);
        else
            axes.along = Vec2(0.0, std::copysign(1.0, local.y()));
    }
    // Loops run counter-clockwise for who looks from outside.
    const double side = signed_area(panel) < 0.0 ? -1.0 : 1.0;
    axes.right = side * Vec2(axes.along.y(), -axes.along.x());
    return axes;
}

/// Extent of points along a direction.
struct Range {
    double low = 1e300, high = -1e300;

    void extend(double x)
    {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    double middle() const { return 0.5 * (low + high); }
    double size() const { return high - low; }
};

/// A panel with `place`, before its vertices are mapped.
class PlacedPanel {
public:
    /// @param points    of the panel [m]
    /// @param distance  added to that of `place` [m]
    PlacedPanel(const Panel& panel, const std::vector<Vec2>& points, double distance,
                const ArrangementSegments& body)
        : place_(*panel.place), segment_(body[size_t(panel.place->at)]), axes_(axes_of(panel, body))
    {
        place_.distance += distance;
        for (const Vec2& x : points) {
            along_.extend(axes_.along.dot(x));
            right_.extend(axes_.right.dot(x));
        }
    }

    /// Least length of the curve on which this panel and another lie side by side [m]. 0 if they do not meet:
    /// on other segments or heights, or one above the other on purpose.
    double length_beside(const PlacedPanel& other) const
    {
        constexpr double kSameAngle = 10.0, kSpare = 1.02; // [degrees], [-]
        const double apart = 0.5 * (along_.size() + other.along_.size());
        const double difference = std::abs(std::remainder(place_.angle_deg - other.place_.angle_deg, 360.0));
        if (!other.place_.wrap || place_.at != other.place_.at || difference < kSameAngle ||
            std::abs(middle() - other.middle()) > apart)
            return 0.0;
        return kSpare * 0.5 * (right_.size() + other.right_.size()) * 360.0 / difference;
    }

    /// @param min_length  of the curve [m]
    void map(const std::vector<Vec2>& points, const std::vector<int>& vertices, double min_length,
             std::vector<Vec3>& out) const
    {
        // Cloth that reaches around itself would start crossed.
        constexpr double kSpare = 1.02, kMinDistance = 1e-3; // [-], [m]
        const double own_length = place_.wrap ? std::max(min_length, kSpare * right_.size()) : 0.0;
        const GirthCurve curve(segment_, middle() - 0.5 * along_.size(), middle() + 0.5 * along_.size(),
                               std::max(place_.distance, kMinDistance), own_length);
        const double arc = curve.arc_at(place_.angle_deg);
        for (size_t i = 0; i < points.size(); ++i) {
            const double height = middle() + axes_.along.dot(points[i]) - along_.middle();
            const double across = axes_.right.dot(points[i]) - right_.middle();
            const Vec2 section = place_.wrap ? curve.at(arc + across) : flat(curve, across);
            out[size_t(vertices[i])] = segment_.start + height * segment_.axis() +
                                       section.x() * segment_.front + section.y() * segment_.left();
        }
    }

private:
    double middle() const { return place_.height * segment_.length(); } ///< along the axis [m]

    /// On the plane that touches the curve, facing the angle.
    Vec2 flat(const GirthCurve& curve, double across) const
    {
        const double angle = place_.angle_deg * std::numbers::pi / 180.0;
        const Vec2 outwards(std::cos(angle), std::sin(angle)), left(-outwards.y(), outwards.x());
        return curve.support(outwards) * outwards + across * left;
    }

    BodyPlacement place_;
    const AxisSegment& segment_;
    PanelAxes axes_;
    Range along_, right_; ///< of the panel [m]
};

/// Distances of the panels from where they would start without layers. [panels] [m]
std::vector<double> layer_distances(const Pattern& pattern)
{
    int lowest = std::numeric_limits<int>::max();
    for (const Panel& panel : pattern.panels)
        lowest = std::min(lowest, panel.layer);
    std::vector<double> distances;
    for (const Panel& panel : pattern.panels)
        distances.push_back(kLayerDistance * (panel.layer - lowest));
    return distances;
}

[[noreturn]] void refuse_without_body(const Pattern& pattern, const Panel& panel)
{
    throw InvalidInput(pattern.source + ": panel " + panel.name +
                       " is placed around a body, and there is none; name an avatar, or remove its place");
}

} // namespace

std::vector<Vec3> place_panels(const Pattern& pattern, View<const Vec2> uv, View<const int> panel_of_vertex,
                               const ArrangementSegments* body)
{
    std::vector<Vec3> x(size_t(uv.size()), Vec3::Zero());
    std::vector<std::vector<int>> vertices(pattern.panels.size());
    std::vector<std::vector<Vec2>> points(pattern.panels.size());
    for (int v = 0; v < uv.size(); ++v) {
        vertices[size_t(panel_of_vertex[v])].push_back(v);
        points[size_t(panel_of_vertex[v])].push_back(uv[v]);
        x[size_t(v)] = pattern.panels[size_t(panel_of_vertex[v])].placement * Vec3(uv[v].x(), uv[v].y(), 0.0);
    }
    const std::vector<double> distances = layer_distances(pattern);
    for (size_t p = 0; p < pattern.panels.size(); ++p)
        if (distances[p] > 0.0)
            for (const int v : vertices[p])
                x[size_t(v)] += distances[p] * outward(pattern.panels[p]);

    std::map<size_t, PlacedPanel> placed;
    for (size_t p = 0; p < pattern.panels.size(); ++p)
        if (const Panel& panel = pattern.panels[p]; panel.place && !points[p].empty()) {
            if (!body)
                refuse_without_body(pattern, panel);
            placed.emplace(p, PlacedPanel(panel, points[p], distances[p], *body));
        }
    for (const auto& [p, panel] : placed) {
        double min_length = 0.0;
        for (const auto& [q, other] : placed)
            if (q != p && pattern.panels[p].layer == pattern.panels[q].layer)
                min_length = std::max(min_length, panel.length_beside(other));
        panel.map(points[p], vertices[p], min_length, x);
    }
    return x;
}

} // namespace toile::garment
