#include "apps/toile/fit/garment_girth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace toile::app {

namespace {

using avatars::SectionLoop;
using avatars::SectionPlane;

const std::string kAroundOthers = "the garment goes around other parts of the body too";
/// Angle [rad] that open cloth takes at least of the part of the body that it lies along: sleeves beside a
/// trunk take less.
constexpr double kAlong = std::numbers::pi / 3.0;
constexpr double kLowering = 0.005; ///< [m] between the levels at which a thigh is tried

/// Angle [rad] by which the first `segments` segments of a closed line go around a point of its plane.
double angle_around(const SectionLoop& curve, size_t segments, const Vec3& point, const SectionPlane& plane)
{
    const Vec2 center = plane.project(point);
    double angle = 0.0;
    for (size_t i = 0; i < segments; ++i) {
        const Vec2 a = plane.project(curve.points[i]) - center,
                   b = plane.project(curve.points[(i + 1) % curve.points.size()]) - center;
        angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    }
    return std::abs(angle);
}

/// Times that a curve goes around a point of its plane.
int turns(const SectionLoop& curve, const Vec3& point, const SectionPlane& plane)
{
    const double angle = angle_around(curve, curve.points.size(), point, plane);
    return int(std::lround(angle / (2.0 * std::numbers::pi)));
}

/// True for a curve that ends at borders and lies along a part of the body, such as the front of a waistcoat.
bool lies_along(const SectionLoop& curve, const Vec3& middle, const SectionPlane& plane)
{
    return !curve.is_closed() && angle_around(curve, curve.points.size() - 1, middle, plane) > kAlong;
}

/// Length at rest of the line in which a plane cuts a triangle [m].
double rest_of_cut(const TriangleMesh& garment, int triangle, const FlatTriangle& rest,
                   const SectionPlane& plane)
{
    const Triangle& t = garment.triangles[size_t(triangle)];
    std::array<double, 3> height;
    for (int k = 0; k < 3; ++k)
        height[size_t(k)] = plane.normal.dot(garment.positions[size_t(t[k])] - plane.point);
    std::array<Vec2, 2> end{Vec2::Zero(), Vec2::Zero()};
    size_t found = 0;
    for (size_t k = 0; k < 3 && found < 2; ++k) {
        const size_t next = (k + 1) % 3;
        if ((height[k] < 0.0) == (height[next] < 0.0))
            continue;
        const double along = height[k] / (height[k] - height[next]);
        end[found++] = rest[k] + along * (rest[next] - rest[k]);
    }
    return (end[1] - end[0]).norm();
}

GarmentGirth girth_of(const SectionLoop& loop, const TriangleMesh& garment,
                      const std::vector<FlatTriangle>& rest, const SectionPlane& plane)
{
    GarmentGirth girth{avatars::closed_length(loop.points), 0.0};
    for (const int t : loop.triangles)
        girth.rest += rest_of_cut(garment, t, rest[size_t(t)], plane);
    return girth;
}

/// Middles of the parts of the body beside the measured one: those that its curve does not enclose.
std::vector<Vec3> other_parts(const TriangleMesh& body, const avatars::Girth& girth)
{
    std::vector<Vec3> middles;
    for (const SectionLoop& part : avatars::cut(body, girth.plane)) {
        const bool is_measured = turns(part, girth.skin.center, girth.plane) != 0;
        if (!is_measured && turns(girth.skin, part.center, girth.plane) == 0)
            middles.push_back(part.center);
    }
    return middles;
}

GirthFit fit(const TriangleMesh& garment, const std::vector<FlatTriangle>& rest, const TriangleMesh& body,
             const avatars::Girth& girth)
{
    GirthFit fit{girth, 0.0, std::nullopt, "no cloth goes around it"};
    const std::vector<Vec3> others = other_parts(body, girth);
    for (const SectionLoop& curve : avatars::cut(garment, girth.plane)) {
        if (lies_along(curve, girth.skin.center, girth.plane))
            fit.not_covered = "the garment ends or is open there";
        if (!curve.is_closed() || turns(curve, girth.skin.center, girth.plane) == 0)
            continue;
        if (std::any_of(others.begin(), others.end(),
                        [&](const Vec3& other) { return turns(curve, other, girth.plane) != 0; })) {
            fit.not_covered = kAroundOthers;
            continue;
        }
        const GarmentGirth found = girth_of(curve, garment, rest, girth.plane);
        if (!fit.garment || found.rest < fit.garment->rest)
            fit.garment = found;
    }
    if (fit.garment)
        fit.not_covered.clear();
    return fit;
}

/// The tape at a lower level of the same limb; nothing where there is no skin.
std::optional<avatars::Girth> lowered(avatars::Girth girth, const TriangleMesh& body, double by)
{
    const Vec3 offset = -by * girth.plane.normal;
    girth.plane.point += offset;
    const Vec3 middle = girth.skin.center + offset;
    const std::vector<SectionLoop> parts = avatars::cut(body, girth.plane);
    const auto nearest =
        std::min_element(parts.begin(), parts.end(), [&](const SectionLoop& a, const SectionLoop& b) {
            return (a.center - middle).squaredNorm() < (b.center - middle).squaredNorm();
        });
    if (nearest == parts.end())
        return std::nullopt;
    girth.skin = *nearest;
    girth.length = avatars::closed_length(avatars::convex_hull(nearest->points, girth.plane));
    return girth;
}

/// Fit of a thigh where a garment has forked, if it does.
std::optional<GirthFit> fit_below_fork(const TriangleMesh& garment, const std::vector<FlatTriangle>& rest,
                                       const TriangleMesh& body, const avatars::Girth& thigh)
{
    for (int k = 1; k * kLowering <= kMaxLowered; ++k) {
        const double by = k * kLowering;
        const std::optional<avatars::Girth> lower = lowered(thigh, body, by);
        if (!lower)
            break;
        GirthFit found = fit(garment, rest, body, *lower);
        found.lowered = by;
        if (found.garment)
            return found;
    }
    return std::nullopt;
}

} // namespace

std::vector<GirthFit> fit_girths(const TriangleMesh& garment, const std::vector<FlatTriangle>& rest,
                                 const TriangleMesh& body, const std::vector<avatars::Girth>& girths)
{
    std::vector<GirthFit> fits;
    for (const avatars::Girth& girth : girths) {
        fits.push_back(fit(garment, rest, body, girth));
        if (girth.key == "leg_circ" && fits.back().not_covered == kAroundOthers)
            if (std::optional<GirthFit> lower = fit_below_fork(garment, rest, body, girth))
                fits.back() = std::move(*lower);
    }
    return fits;
}

} // namespace toile::app
