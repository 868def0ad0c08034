#include "garment/pattern/place/placement_shift.h"

#include <algorithm>
#include <cmath>

#include "core/base/number.h"
#include "garment/pattern/edge_curve.h"

namespace toile::garment {

namespace {

/// A point of the outside of a panel, as the pattern places it.
struct Sample {
    Vec3 x;
    Vec3 outwards; ///< unit
};

/// The border of a panel as a polygon.
std::vector<Vec2> outline(const Panel& panel)
{
    constexpr int kParts = 8;
    std::vector<Vec2> points;
    for (size_t e = 0; e < panel.edges.size(); ++e) {
        const EdgeCurve curve(panel, int(e));
        for (int k = 0; k < kParts; ++k)
            points.push_back(curve.at(double(k) / kParts));
    }
    return points;
}

bool is_inside(const Vec2& x, const std::vector<Vec2>& polygon)
{
    bool inside = false;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        if ((a.y() > x.y()) != (b.y() > x.y()) &&
            x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
            inside = !inside;
    }
    return inside;
}

/// Points on a grid of this width count the same area each [m].
constexpr double kGrid = 0.04;

void add_samples(const Panel& panel, std::vector<Sample>& samples)
{
    const std::vector<Vec2> border = outline(panel);
    Vec2 low = border.front(), high = border.front();
    for (const Vec2& x : border) {
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
    }
    const Vec3 outwards = outward(panel);
    for (double u = low.x() + 0.5 * kGrid; u < high.x(); u += kGrid)
        for (double v = low.y() + 0.5 * kGrid; v < high.y(); v += kGrid)
            if (is_inside({u, v}, border))
                samples.push_back({panel.placement * Vec3(u, v, 0.0), outwards});
}

/// Skin of the whole body, sorted by height.
class Skin {
public:
    explicit Skin(const ArrangementSegments& body)
    {
        for (const AxisSegment& segment : body)
            points_.insert(points_.end(), segment.skin.begin(), segment.skin.end());
        std::sort(points_.begin(), points_.end(), [](const Vec3& a, const Vec3& b) {
            return a.y() != b.y() ? a.y() < b.y() : a.x() != b.x() ? a.x() < b.x() : a.z() < b.z();
        });
    }

    /// Whether there is skin behind a panel: within a cylinder inwards from a point of it.
    bool is_behind(const Sample& sample) const
    {
        constexpr double kRadius = 0.03, kDepth = 0.5; // [m]
        const double reach = kRadius + kDepth * std::abs(sample.outwards.y());
        const auto first = std::lower_bound(points_.begin(), points_.end(), sample.x.y() - reach,
                                            [](const Vec3& p, double y) { return p.y() < y; });
        for (auto p = first; p != points_.end() && p->y() < sample.x.y() + reach; ++p) {
            const Vec3 r = *p - sample.x;
            const double depth = -sample.outwards.dot(r);
            if (depth > 0.0 && depth < kDepth &&
                (r + depth * sample.outwards).squaredNorm() < kRadius * kRadius)
                return true;
        }
        return false;
    }

    double lowest() const { return points_.empty() ? 0.0 : points_.front().y(); }

private:
    std::vector<Vec3> points_;
};

double covering(const Skin& skin, const std::vector<Sample>& samples, const Vec3& shift)
{
    size_t covered = 0;
    for (const Sample& sample : samples)
        covered += skin.is_behind({sample.x + shift, sample.outwards});
    return double(covered) / double(samples.size());
}

double to_centimetres(double x) { return std::round(100.0 * x) / 100.0 + 0.0; }

/// Part of a garment that has skin behind it at least: wide skirts have little [-].
constexpr double kSome = 0.1;

/// Shifts that carry an origin in use onto this body's.
std::vector<Vec3> candidate_shifts(const ArrangementSegments& body, const Skin& skin,
                                   const std::vector<Sample>& samples)
{
    // The chest of SMPL's template between crotch and collarbones.
    constexpr double kChest = 0.55; // [-]
    constexpr double kFar = 0.1;    // [m] at which a body stands beside the pattern
    const AxisSegment& torso = body[size_t(BodySegment::Torso)];
    const double chest = torso.start.y() + kChest * (torso.end.y() - torso.start.y());

    Vec3 low = samples.front().x, high = low;
    for (const Sample& sample : samples) {
        low = low.cwiseMin(sample.x);
        high = high.cwiseMax(sample.x);
    }
    Vec3 aside = torso.start - 0.5 * (low + high);
    for (const int axis : {0, 2})
        aside[axis] = std::abs(aside[axis]) < kFar ? 0.0 : to_centimetres(aside[axis]);

    std::vector<Vec3> shifts;
    for (const double x : {0.0, aside.x()})
        for (const double z : {0.0, aside.z()})
            for (const double y : {0.0, to_centimetres(skin.lowest()), to_centimetres(chest)})
                shifts.emplace_back(x, y, z);
    return shifts;
}

std::string percent(double fraction) { return std::to_string(int(std::lround(100.0 * fraction))) + " %"; }

} // namespace

bool PlacementShift::fits() const
{
    constexpr double kMuchBetter = 1.3; // [-]
    return covering >= kSome && covering_shifted < kMuchBetter * covering;
}

PlacementShift placement_shift(const Pattern& pattern, const ArrangementSegments& body)
{
    std::vector<Sample> samples;
    for (const Panel& panel : pattern.panels)
        if (!panel.place)
            add_samples(panel, samples);
    PlacementShift result;
    if (samples.empty())
        return result;

    const Skin skin(body);
    result.covering = result.covering_shifted = covering(skin, samples, Vec3::Zero());
    for (const Vec3& shift : candidate_shifts(body, skin, samples))
        if (const double shifted = covering(skin, samples, shift); shifted > result.covering_shifted) {
            result.covering_shifted = shifted;
            result.shift = shift;
        }
    return result;
}

std::string misplacement_text(const Pattern& pattern, const PlacementShift& placement)
{
    const std::string where = pattern.source +
                              ": its panels are not placed around the body: " + percent(placement.covering) +
                              " of them have skin behind them";
    if (placement.shift.isZero() || placement.covering_shifted < kSome)
        return where + "; name the body that they were drafted for, or place them with \"place\"";
    const Vec3& s = placement.shift;
    return where + ", " + percent(placement.covering_shifted) + " after --shift " + short_text(s.x()) + "," +
           short_text(s.y()) + "," + short_text(s.z()) + "; was the pattern drafted for another origin?";
}

} // namespace toile::garment
