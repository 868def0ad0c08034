#include "garment/pattern/edge_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace toile::garment {
namespace {

/// Chords of a curved edge. A chord of 1/512 of a half circle is short of its arc by 2e-6 of itself.
constexpr int kChords = 512;

Vec2 lerp(const Vec2& a, const Vec2& b, double t) { return a + t * (b - a); }

/// De Casteljau's algorithm.
Vec2 point_on(std::vector<Vec2> controls, double t)
{
    for (size_t left = controls.size() - 1; left > 0; --left)
        for (size_t i = 0; i < left; ++i)
            controls[i] = lerp(controls[i], controls[i + 1], t);
    return controls.front();
}

std::vector<Vec2> sample(const Vec2& start, const Vec2& end, const Bezier& bezier)
{
    if (bezier.controls.empty())
        return {start, end};
    std::vector<Vec2> controls{start};
    controls.insert(controls.end(), bezier.controls.begin(), bezier.controls.end());
    controls.push_back(end);
    std::vector<Vec2> points;
    for (int i = 0; i <= kChords; ++i)
        points.push_back(point_on(controls, double(i) / kChords));
    return points;
}

std::vector<Vec2> sample(const Vec2& start, const Vec2& end, const CircularArc& arc)
{
    // The centre is on the bisector: left of travel for a short arc that turns counter-clockwise.
    const Vec2 chord = end - start;
    const double half = 0.5 * chord.norm();
    const double height = std::sqrt(std::max(0.0, arc.radius * arc.radius - half * half));
    const Vec2 left = Vec2(-chord.y(), chord.x()) / (2.0 * half);
    const double side = arc.counter_clockwise != arc.large ? 1.0 : -1.0;
    const Vec2 centre = 0.5 * (start + end) + side * height * left;

    const double half_angle = std::asin(std::min(1.0, half / arc.radius));
    const double angle = 2.0 * (arc.large ? std::numbers::pi - half_angle : half_angle);
    const double turn = arc.counter_clockwise ? angle : -angle;
    std::vector<Vec2> points;
    for (int i = 0; i <= kChords; ++i)
        points.push_back(centre + Eigen::Rotation2Dd(turn * i / kChords) * (start - centre));
    points.back() = end;
    return points;
}

} // namespace

bool is_straight(const PanelEdge& edge)
{
    const auto* bezier = std::get_if<Bezier>(&edge.curve);
    return bezier != nullptr && bezier->controls.empty();
}

EdgeCurve::EdgeCurve(const Panel& panel, int edge)
{
    if (const PanelLine* line = line_of(panel, edge)) {
        points_ = line->points;
        measure();
        return;
    }
    const PanelEdge& side = panel.edges[edge];
    const Vec2& start = panel.corners[side.start];
    const Vec2& end = panel.corners[side.end];
    if (const auto* arc = std::get_if<CircularArc>(&side.curve)) {
        const double half = 0.5 * (end - start).norm();
        if (!(arc->radius >= half * (1.0 - 1e-6)) || half == 0.0)
            throw InvalidInput("panel \"" + panel.name + "\", edge " + std::to_string(edge) +
                               ": an arc of radius " + std::to_string(arc->radius) +
                               " m cannot join ends that are " + std::to_string(2.0 * half) +
                               " m apart; use at least half that distance");
    }
    points_ = std::visit([&](const auto& curve) { return sample(start, end, curve); }, side.curve);
    measure();
}

void EdgeCurve::measure()
{
    lengths_.push_back(0.0);
    for (size_t i = 1; i < points_.size(); ++i)
        lengths_.push_back(lengths_.back() + (points_[i] - points_[i - 1]).norm());
}

std::vector<double> EdgeCurve::corner_fractions() const
{
    std::vector<double> fractions;
    for (size_t i = 1; i + 1 < lengths_.size(); ++i)
        fractions.push_back(lengths_[i] / length());
    return fractions;
}

Vec2 EdgeCurve::at(double fraction) const
{
    if (fraction <= 0.0)
        return points_.front();
    if (fraction >= 1.0)
        return points_.back();
    const double s = fraction * length();
    const size_t next = std::clamp<size_t>(
        std::upper_bound(lengths_.begin(), lengths_.end(), s) - lengths_.begin(), 1, points_.size() - 1);
    const double chord = lengths_[next] - lengths_[next - 1];
    return lerp(points_[next - 1], points_[next], chord > 0.0 ? (s - lengths_[next - 1]) / chord : 0.0);
}

double signed_area(const Panel& panel)
{
    double twice = 0.0;
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const EdgeCurve curve(panel, int(e));
        // Straight edges have one chord; curved ones are walked.
        const int chords = is_straight(panel.edges[e]) ? 1 : kChords;
        Vec2 from = curve.at(0.0);
        for (int i = 1; i <= chords; ++i) {
            const Vec2 to = curve.at(double(i) / chords);
            twice += from.x() * to.y() - from.y() * to.x();
            from = to;
        }
    }
    return 0.5 * twice;
}

Vec3 outward(const Panel& panel)
{
    return (signed_area(panel) < 0.0 ? -1.0 : 1.0) * panel.placement.linear().col(2);
}

} // namespace toile::garment
