#include "collision/check/passages.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include "core/base/stages.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Way relative to a body below which nothing is looked at [m]: cloth that slow crosses in some frame.
constexpr double kMinWay = 0.002;

/// Cosine of the normals where a way enters and leaves a body, below which it goes through.
constexpr double kOpposite = -0.1;

/// Least depth of a way through a shape [m].
constexpr double kMinDepth = 1e-4;

/// Rays to where a sample was and is reach a little beyond it, so that they meet the cloth around it; those to
/// where no cloth should be reach farther [-].
constexpr double kBeyond = 1.05, kFar = 4.0;

/// Directions beside the way of a sample in which cloth is looked for.
constexpr int kSideways = 8;

/// Way of a sample through a body, from a point within it.
struct Through {
    Vec3 middle0, middle1; ///< the point in both frames [m]
    Vec3 behind, ahead;    ///< from there to where the sample was and is, in the first frame [m]
    Mat3 turn;             ///< of the body to the second frame
    bool is_pinched;
};

RayScene rays_of(View<const Triangle> triangles, View<const Vec3> x)
{
    RayScene rays;
    rays.add(x, triangles);
    rays.commit();
    return rays;
}

/// Orthonormal frame of a triangle, at its first corner.
Eigen::Isometry3d frame_of(const Triangle& t, View<const Vec3> x)
{
    const Vec3 edge = (x[t[1]] - x[t[0]]).normalized();
    const Vec3 normal = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).normalized();
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.linear() << edge, normal, edge.cross(normal);
    frame.translation() = x[t[0]];
    return frame;
}

/// The way of a sample through a mesh, relative to the face that is nearest to it.
std::optional<Through> way_through(const Vec3& x0, const Vec3& x1, const PenetrationMeter& body,
                                   View<const Vec3> y1, double max_motion)
{
    constexpr int kMaxHits = 32;
    const double reach = (x1 - x0).norm() + max_motion;
    if (!(reach > kMinWay))
        return std::nullopt;
    const SurfaceProximity& surface = body.surface();
    const std::optional<SurfacePoint> nearest = surface.closest(x0, reach);
    if (!nearest)
        return std::nullopt;
    const View<const Vec3> y0 = surface.positions();
    const auto frames_of = [&](int triangle) {
        const Triangle& t = surface.triangles()[triangle];
        return std::pair(frame_of(t, y0), frame_of(t, y1));
    };
    const auto [f0, f1] = frames_of(nearest->triangle);
    const Eigen::Isometry3d second_from_first = f1 * f0.inverse();
    const Vec3 end = second_from_first.inverse() * x1, way = end - x0;
    if (way.norm() <= std::max(kMinWay, nearest->distance()))
        return std::nullopt;

    // Which side of a hit face the sample is on in both frames, relative to that face.
    const auto goes = [&](const RayHit& hit, double from, double to) {
        const auto [h0, h1] = frames_of(hit.triangle);
        return from * (h0.inverse() * x0).y() > 0.0 && to * (h1.inverse() * x1).y() > 0.0;
    };
    std::optional<RayHit> entry;
    double entered = 0.0, from = 0.0;
    for (int k = 0; k < kMaxHits; ++k) {
        const std::optional<RayHit> hit = body.rays().closest_hit(x0 + from * way, way, 1.0 - from);
        if (!hit)
            return std::nullopt;
        from += std::max(hit->t, 1e-6);
        const Vec3 normal = surface.face_normal(hit->triangle);
        if (normal.dot(way) < 0.0 && goes(*hit, 1.0, -1.0)) {
            entry = hit;
            entered = from;
        } else if (entry && normal.dot(way) > 0.0 && goes(*hit, -1.0, 1.0) &&
                   normal.dot(surface.face_normal(entry->triangle)) < kOpposite) {
            const double middle = 0.5 * (entered + from);
            const Vec3 c = x0 + middle * way;
            return Through{c,
                           second_from_first * c,
                           -middle * way,
                           (1.0 - middle) * way,
                           second_from_first.linear(),
                           body.is_pinched(x0 + entered * way, {}) || body.is_pinched(x0 + from * way, {})};
        }
    }
    return std::nullopt;
}

/// The way of a sample through a convex shape, in the shape's frame.
std::optional<Through> way_through(const Vec3& x0, const Vec3& x1, const Shape& shape,
                                   const Eigen::Isometry3d& pose0, const Eigen::Isometry3d& pose1)
{
    const Vec3 a = pose0.inverse() * x0, b = pose1.inverse() * x1, way = b - a;
    if (!(way.norm() > kMinWay))
        return std::nullopt;
    const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
    const auto at = [&](double t) { return closest(shape, still, a + t * way); };
    const auto distance = [&](double t) { return at(t).signed_distance; };
    const double first = distance(0.0), last = distance(1.0);
    if (first <= 0.0 || last <= 0.0 || first + last > way.norm())
        return std::nullopt;

    // The signed distance of a convex shape is convex along the way.
    double lower = 0.0, upper = 1.0;
    for (int k = 0; k < 40; ++k) {
        const double left = lower + (upper - lower) / 3.0, right = upper - (upper - lower) / 3.0;
        (distance(left) < distance(right) ? upper : lower) = distance(left) < distance(right) ? right : left;
    }
    const double middle = 0.5 * (lower + upper);
    if (distance(middle) > -kMinDepth)
        return std::nullopt;
    const auto surface_between = [&](double outside, double inside) {
        for (int k = 0; k < 40; ++k) {
            const double half = 0.5 * (outside + inside);
            (distance(half) > 0.0 ? outside : inside) = half;
        }
        return outside;
    };
    if (at(surface_between(0.0, middle)).normal.dot(at(surface_between(1.0, middle)).normal) >= kOpposite)
        return std::nullopt;
    const Vec3 c = a + middle * way;
    return Through{pose0 * c,
                   pose1 * c,
                   pose0.linear() * (a - c),
                   pose0.linear() * (b - c),
                   pose1.linear() * pose0.linear().transpose(),
                   false};
}

/// True if the cloth has gone from behind to ahead, and was not beside the body all the time.
bool has_passed(const Through& way, const RayScene& before, const RayScene& after)
{
    const auto was = [&](const Vec3& at, double reach) { return before.occluded(way.middle0, at, reach); };
    const auto is = [&](const Vec3& at, double reach) {
        return after.occluded(way.middle1, way.turn * at, reach);
    };
    if (!was(way.behind, kBeyond) || !is(way.ahead, kBeyond) || was(way.ahead, kFar) ||
        is(way.behind, kFar))
        return false;
    const Vec3 side = way.ahead.unitOrthogonal() * std::max(way.behind.norm(), way.ahead.norm());
    for (int k = 0; k < kSideways; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSideways;
        const Vec3 at = Eigen::AngleAxisd(angle, way.ahead.normalized()) * side;
        if (was(at, kFar) && is(at, kFar))
            return false;
    }
    return true;
}

/// Samples whose way leads through a body, with the cloth around them.
template <typename WayOf>
std::vector<Passage> find(const ClothFrames& cloth, const WayOf& way_of)
{
    const StageScope stage("collision/passages");
    const std::vector<Vec3> from = cloth.samples.at(cloth.x0), to = cloth.samples.at(cloth.x1);
    std::vector<std::pair<int, Through>> ways;
    parallel_append(
        kCpu, "collision/passages", int(from.size()),
        [&](int begin, int end, std::vector<std::pair<int, Through>>& found) {
            for (int i = begin; i < end; ++i)
                if (!cloth.samples.is_on_border(i))
                    if (const std::optional<Through> way = way_of(from[i], to[i]))
                        found.emplace_back(i, *way);
        },
        ways);
    std::vector<Passage> passages;
    if (ways.empty())
        return passages;
    const RayScene before = rays_of(cloth.samples.triangles(), cloth.x0),
                   after = rays_of(cloth.samples.triangles(), cloth.x1);
    for (const auto& [sample, way] : ways)
        if (has_passed(way, before, after))
            passages.push_back({sample, way.middle0, way.is_pinched});
    return passages;
}

} // namespace

std::vector<Passage> find_passages(const ClothFrames& cloth, const PenetrationMeter& body,
                                   View<const Vec3> y1)
{
    const View<const Vec3> y0 = body.surface().positions();
    double max_motion = 0.0;
    for (int i = 0; i < y0.size(); ++i)
        max_motion = std::max(max_motion, (y1[i] - y0[i]).norm());
    return find(cloth,
                [&](const Vec3& x0, const Vec3& x1) { return way_through(x0, x1, body, y1, max_motion); });
}

std::vector<Passage> find_passages(const ClothFrames& cloth, const Shape& shape,
                                   const Eigen::Isometry3d& pose0, const Eigen::Isometry3d& pose1)
{
    return find(cloth,
                [&](const Vec3& x0, const Vec3& x1) { return way_through(x0, x1, shape, pose0, pose1); });
}

} // namespace toile::collision
