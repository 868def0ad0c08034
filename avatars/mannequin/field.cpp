#include "avatars/mannequin/field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace toile::avatars {

namespace {

/// First-order distance to the ellipsoid |q / r| = 1: f / |grad f| with f = |q / r| - 1.
double ellipsoid_distance(const Vec3& q, const Vec3& r)
{
    const Vec3 scaled = q.cwiseQuotient(r);
    const double level = scaled.norm();
    const double slope = scaled.cwiseQuotient(r).norm();
    return slope < 1e-9 ? -r.minCoeff() : level * (level - 1.0) / slope;
}

constexpr std::array<double Section::*, 5> kShape{&Section::u, &Section::v, &Section::side, &Section::front,
                                                  &Section::behind};

} // namespace

double smooth_union(double a, double b, double k)
{
    const double h = std::max(1.0 - std::abs(a - b) / k, 0.0);
    return std::min(a, b) - 0.25 * k * h * h;
}

Loft::Loft(Frame frame, std::vector<Section> sections, double cap_low, double cap_high)
    : frame_(std::move(frame)), sections_(std::move(sections)), cap_low_(cap_low), cap_high_(cap_high)
{
}

Section Loft::section_at(double s) const
{
    // Find the interval of s; beyond the ends use the last section.
    const int last = int(sections_.size()) - 1;
    if (s <= sections_.front().s)
        return sections_.front();
    if (s >= sections_[last].s)
        return sections_[last];
    int i = 0;
    while (sections_[i + 1].s < s)
        ++i;

    // Cubic Hermite with the slopes of the neighbours' chords.
    const Section& p0 = sections_[std::max(i - 1, 0)];
    const Section& p1 = sections_[i];
    const Section& p2 = sections_[i + 1];
    const Section& p3 = sections_[std::min(i + 2, last)];
    const double width = p2.s - p1.s;
    const double t = (s - p1.s) / width;
    const double a = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t), b = t * (1.0 - t) * (1.0 - t) * width;
    const double c = t * t * (3.0 - 2.0 * t), d = t * t * (t - 1.0) * width;
    Section result;
    result.s = s;
    for (const auto part : kShape) {
        const double slope1 = (p2.*part - p0.*part) / (p2.s - p0.s);
        const double slope2 = (p3.*part - p1.*part) / (p3.s - p1.s);
        result.*part = a * p1.*part + b * slope1 + c * p2.*part + d * slope2;
    }
    return result;
}

double Loft::distance(const Vec3& p) const
{
    const Vec3 local = p - frame_.origin;
    const double s = local.dot(frame_.S);
    const Section section = section_at(s);
    const double u = local.dot(frame_.U) - section.u;
    const double v = local.dot(frame_.V) - section.v;
    const double depth = v >= 0.0 ? section.front : section.behind;

    // Beyond an end, use the cap: a half ellipsoid over the end section.
    const double below = sections_.front().s - s;
    const double above = s - sections_.back().s;
    if (below > 0.0)
        return ellipsoid_distance({u, v, below}, {section.side, depth, cap_low_});
    if (above > 0.0)
        return ellipsoid_distance({u, v, above}, {section.side, depth, cap_high_});
    return ellipsoid_distance({u, v, 0.0}, {section.side, depth, 1.0});
}

Vec3 Loft::center(double s) const
{
    const Section section = section_at(s);
    return frame_.origin + s * frame_.S + section.u * frame_.U + section.v * frame_.V;
}

double Ellipsoid::distance(const Vec3& p) const { return ellipsoid_distance(p - center, radii); }

double RoundCone::distance(const Vec3& p) const
{
    const Vec3 axis = b - a;
    const double t = std::clamp((p - a).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    return (p - a - t * axis).norm() - ((1.0 - t) * radius_a + t * radius_b);
}

} // namespace toile::avatars
