#include "garment/pattern/place/girth_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mesh/polygon.h"

namespace toile::garment {

namespace {

/// Skin this far beyond a panel counts too, so that coarse meshes are not missed between vertices [m].
constexpr double kMargin = 0.03;

std::vector<Vec2> hull_of(const AxisSegment& segment, double low, double high)
{
    const Vec3 axis = segment.axis(), left = segment.left();
    std::vector<Vec2> points{Vec2::Zero()}; // the axis is inside, also of a bent arm
    for (const Vec3& x : segment.skin) {
        const Vec3 r = x - segment.start;
        const double height = axis.dot(r);
        if (height > low - kMargin && height < high + kMargin)
            points.emplace_back(segment.front.dot(r), left.dot(r));
    }
    return convex_hull(std::move(points));
}

/// Hull of circles around the corners: the parallel curve at `distance`.
std::vector<Vec2> parallel_curve(const std::vector<Vec2>& hull, double distance)
{
    constexpr int kSides = 64;
    const double radius = distance / std::cos(std::numbers::pi / kSides); // circumscribed
    std::vector<Vec2> points;
    for (const Vec2& corner : hull)
        for (int k = 0; k < kSides; ++k) {
            const double angle = 2.0 * std::numbers::pi * (k + 0.5) / kSides;
            points.push_back(corner + radius * Vec2(std::cos(angle), std::sin(angle)));
        }
    return convex_hull(std::move(points));
}

double perimeter(const std::vector<Vec2>& corners)
{
    double length = 0.0;
    for (size_t i = 0; i < corners.size(); ++i)
        length += (corners[(i + 1) % corners.size()] - corners[i]).norm();
    return length;
}

} // namespace

GirthCurve::GirthCurve(const AxisSegment& segment, double low, double high, double distance,
                       double min_length)
{
    const std::vector<Vec2> hull = hull_of(segment, low, high);
    corners_ = parallel_curve(hull, distance);
    // A parallel curve is longer by its distance times 2 pi.
    if (const double missing = min_length - perimeter(corners_); missing > 0.0)
        corners_ = parallel_curve(hull, distance + missing / (2.0 * std::numbers::pi));
    corners_.push_back(corners_.front());
    arc_.push_back(0.0);
    for (size_t i = 1; i < corners_.size(); ++i)
        arc_.push_back(arc_.back() + (corners_[i] - corners_[i - 1]).norm());
}

double GirthCurve::arc_at(double angle_deg) const
{
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const Vec2 ray(std::cos(angle), std::sin(angle)), across(-ray.y(), ray.x());
    for (size_t i = 1; i < corners_.size(); ++i) {
        const Vec2 &a = corners_[i - 1], &b = corners_[i];
        const double from = across.dot(a), to = across.dot(b);
        if (from <= 0.0 && to > 0.0 && ray.dot(a) + ray.dot(b) > 0.0) {
            const double t = -from / (to - from);
            return arc_[i - 1] + t * (arc_[i] - arc_[i - 1]);
        }
    }
    return 0.0;
}

Vec2 GirthCurve::at(double arc) const
{
    arc -= std::floor(arc / length()) * length();
    const auto above = std::upper_bound(arc_.begin() + 1, arc_.end() - 1, arc);
    const auto i = size_t(above - arc_.begin());
    const double t = (arc - arc_[i - 1]) / (arc_[i] - arc_[i - 1]);
    return corners_[i - 1] + t * (corners_[i] - corners_[i - 1]);
}

double GirthCurve::support(const Vec2& direction) const
{
    double most = 0.0;
    for (const Vec2& corner : corners_)
        most = std::max(most, direction.dot(corner));
    return most;
}

} // namespace toile::garment
