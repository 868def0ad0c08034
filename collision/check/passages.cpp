#include "collision/check/passages.h"

#include <algorithm>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

#include "core/base/stages.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Displacement relative to a body below which nothing is looked at [m]: what cloth that slow goes through is
/// thinner than the cloth.
constexpr double kMinPath = 0.002;

/// Cosine of the normals where a path enters and leaves a body, below which it goes through.
constexpr double kOpposite = -0.1;

/// Least depth of a path through a shape [m].
constexpr double kMinDepth = 1e-4;

/// Directions beside a path in which cloth is looked for.
constexpr int kSideways = 8;

/// Distance behind a hit from which on the next one is looked for [m]; most hits of a path.
constexpr double kPastHit = 1e-5;
constexpr int kMaxHits = 64;

/// Slope by which rays along a path leave it [-]: they would meet a vertex, where hits are ambiguous.
constexpr double kAside = 1e-3;

/// Path of a sample through a body.
struct PathThrough {
    Vec3 middle0, middle1; ///< a point of the path within the body, in both frames [m]
    Vec3 direction;        ///< unit, in the first frame
    Mat3 rotation;         ///< of the body to the second frame
    bool is_pinched;
};

RayScene rays_of(View<const Triangle> triangles, View<const Vec3> x)
{
    RayScene rays;
    rays.add(x, triangles);
    rays.commit();
    return rays;
}

/// True if cloth that lay behind the middle of a path no longer does, and in no direction stayed where it
/// was. Seen from a point that cloth does not go through, the number of layers in a direction is odd or even
/// for ever, unless a border comes past.
bool has_passed(const PathThrough& path, const RayScene& before, const RayScene& after)
{
    const Vec3 side = path.direction.unitOrthogonal();
    const auto was_odd = [&](const Vec3& towards) {
        return before.hit_count(path.middle0, towards) % 2 != 0;
    };
    const auto stays_odd = [&](const Vec3& towards) {
        return was_odd(towards) && after.hit_count(path.middle1, path.rotation * towards) % 2 != 0;
    };
    const Vec3 behind = (-path.direction + kAside * side).normalized();
    const Vec3 ahead = (path.direction + kAside * side).normalized();
    if (!was_odd(behind) || stays_odd(behind) || stays_odd(ahead))
        return false;
    for (int k = 0; k < kSideways; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSideways;
        if (stays_odd(Eigen::AngleAxisd(angle, path.direction) * side))
            return false;
    }
    return true;
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

/// Path of a sample through a mesh, relative to the face that is nearest to it.
std::optional<PathThrough> path_through(const Vec3& x0, const Vec3& x1, const PenetrationMeter& body,
                                        View<const Vec3> y1, double max_motion)
{
    const double reach = (x1 - x0).norm() + max_motion;
    if (!(reach > kMinPath))
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
    const Vec3 path = second_from_first.inverse() * x1 - x0;
    const double length = path.norm();
    if (length <= std::max(kMinPath, nearest->distance()))
        return std::nullopt;
    const Vec3 direction = path / length;

    // Whether the sample comes from the front (1) or the back (-1) of a face to the other side of it,
    // relative to that face; 0 if it does not.
    const auto side_left = [&](int triangle) {
        const auto [h0, h1] = frames_of(triangle);
        const double before = (h0.inverse() * x0).y(), after = (h1.inverse() * x1).y();
        return before > 0.0 && after < 0.0 ? 1 : before < 0.0 && after > 0.0 ? -1 : 0;
    };
    const auto through = [&](double entered, double left) {
        const Vec3 middle = x0 + 0.5 * (entered + left) * direction;
        return PathThrough{middle, second_from_first * middle, direction, second_from_first.linear(),
                           body.is_pinched(x0 + entered * direction, {}) ||
                               body.is_pinched(x0 + left * direction, {})};
    };
    std::optional<RayHit> entry;
    double entered = 0.0, from = 0.0;
    for (int k = 0; k < kMaxHits; ++k) {
        const std::optional<RayHit> hit =
            body.rays().closest_hit(x0 + from * direction, direction, length - from);
        if (!hit)
            return std::nullopt;
        const double at = from + hit->t;
        from = at + kPastHit;
        const int side = side_left(hit->triangle);
        if (!body.is_closed() && side != 0)
            return through(at, at);
        const Vec3 normal = surface.face_normal(hit->triangle);
        if (normal.dot(direction) < 0.0) {
            entry = side == 1 ? hit : std::nullopt;
            entered = at;
        } else {
            if (entry && side == -1 && normal.dot(surface.face_normal(entry->triangle)) < kOpposite)
                return through(entered, at);
            entry.reset();
        }
    }
    return std::nullopt;
}

/// Path of a sample through a convex shape, in the shape's frame.
std::optional<PathThrough> path_through(const Vec3& x0, const Vec3& x1, const Shape& shape,
                                        const Eigen::Isometry3d& pose0, const Eigen::Isometry3d& pose1)
{
    const Vec3 a = pose0.inverse() * x0, b = pose1.inverse() * x1, path = b - a;
    if (!(path.norm() > kMinPath))
        return std::nullopt;
    const Eigen::Isometry3d still = Eigen::Isometry3d::Identity();
    const auto at = [&](double t) { return closest(shape, still, a + t * path); };
    const auto distance = [&](double t) { return at(t).signed_distance; };
    const double first = distance(0.0), last = distance(1.0);
    if (first <= 0.0 || last <= 0.0 || first + last > path.norm())
        return std::nullopt;

    // The signed distance of a convex shape is convex along the path.
    double lower = 0.0, upper = 1.0;
    for (int k = 0; k < 40; ++k) {
        const double left = lower + (upper - lower) / 3.0, right = upper - (upper - lower) / 3.0;
        const bool is_lower = distance(left) < distance(right);
        (is_lower ? upper : lower) = is_lower ? right : left;
    }
    const double middle = 0.5 * (lower + upper);
    if (distance(middle) > -kMinDepth)
        return std::nullopt;
    const auto normal_between = [&](double outside, double inside) {
        for (int k = 0; k < 40; ++k) {
            const double half = 0.5 * (outside + inside);
            (distance(half) > 0.0 ? outside : inside) = half;
        }
        return at(outside).normal;
    };
    if (normal_between(0.0, middle).dot(normal_between(1.0, middle)) >= kOpposite)
        return std::nullopt;
    const Vec3 within = a + middle * path;
    return PathThrough{pose0 * within, pose1 * within, pose0.linear() * path.normalized(),
                       pose1.linear() * pose0.linear().transpose(), false};
}

/// Samples whose path leads through a body, with the cloth around them.
template <typename PathOf>
std::vector<Passage> find(const ClothFrames& cloth, const PathOf& path_of)
{
    const StageScope stage("collision/passages");
    std::vector<std::pair<int, PathThrough>> paths;
    parallel_append(
        kCpu, "collision/passages", int(cloth.from.size()),
        [&](int begin, int end, std::vector<std::pair<int, PathThrough>>& found) {
            for (int i = begin; i < end; ++i)
                if (!cloth.samples.is_on_border(i))
                    if (const std::optional<PathThrough> path = path_of(cloth.from[i], cloth.to[i]))
                        found.emplace_back(i, *path);
        },
        paths);
    std::vector<Passage> passages;
    if (paths.empty())
        return passages;
    const RayScene before = rays_of(cloth.samples.triangles(), cloth.x0),
                   after = rays_of(cloth.samples.triangles(), cloth.x1);
    for (const auto& [sample, path] : paths)
        if (has_passed(path, before, after))
            passages.push_back({sample, path.middle0, path.is_pinched});
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
                [&](const Vec3& x0, const Vec3& x1) { return path_through(x0, x1, body, y1, max_motion); });
}

std::vector<Passage> find_passages(const ClothFrames& cloth, const Shape& shape,
                                   const Eigen::Isometry3d& pose0, const Eigen::Isometry3d& pose1)
{
    return find(cloth,
                [&](const Vec3& x0, const Vec3& x1) { return path_through(x0, x1, shape, pose0, pose1); });
}

} // namespace toile::collision
