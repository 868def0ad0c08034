#include "apps/preview/path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace toile::preview {

namespace {

/// Offset of secondary rays above their surface over the scene's diagonal [-]: 0.04 mm for a person. Less
/// hits the surface itself in single precision; more lets light in under a hem.
constexpr double kStepOff = 2e-5;

/// Cosine of the angle between a triangle and the smooth normal of a corner from which on the corner lies on
/// a sharp fold, as of a pleat, and is shaded as the triangle is [-]: 60 degrees.
constexpr double kSharp = 0.5;

/// The floor is opaque up to the first distance and fades into the background at the second, in scene
/// diagonals around the scene's centre [-].
constexpr double kFadeStart = 0.9, kFadeEnd = 3.2;

/// Fraction of the floor's shadow removed [-]: the rest of the floor would light it up, and it should not
/// compete with the cloth.
constexpr double kShadowRelief = 0.18;

/// Light reflected by a neighbouring surface, over that reflected by an unoccluded one [-].
constexpr double kBounce = 0.45;

/// Light from an occluded direction onto the floor, over that of the open sky [-]: its bounce is not traced.
constexpr double kHiddenSky = 0.25;

const Vec3 kBackgroundTop(0.66, 0.73, 0.80);
const Vec3 kBackgroundHorizon(0.90, 0.89, 0.87);
const Vec3 kFloor(0.74, 0.73, 0.71);

/// Two unit vectors that complete `axis` to an orthonormal frame.
std::pair<Vec3, Vec3> frame_around(const Vec3& axis)
{
    const Vec3 first = axis.unitOrthogonal();
    return {first, axis.cross(first)};
}

/// Random direction about `normal` with density cos / pi.
Vec3 cosine_direction(const Vec3& normal, const Vec2& random)
{
    const double radius = std::sqrt(random.x()), angle = 2.0 * std::numbers::pi * random.y();
    const auto [a, b] = frame_around(normal);
    return radius * (std::cos(angle) * a + std::sin(angle) * b) + std::sqrt(1.0 - random.x()) * normal;
}

bool second_color(const Material& material, const Vec2& coordinates)
{
    const double u = std::floor(coordinates.x() / material.print_size);
    const double v = std::floor(coordinates.y() / material.print_size);
    switch (material.print) {
    case Print::Plain:
        return false;
    case Print::Checker:
        return std::fmod(std::abs(u + v), 2.0) == 1.0;
    case Print::Stripes:
        return std::fmod(std::abs(u), 2.0) == 1.0;
    }
    return false;
}

} // namespace

PathTracer::PathTracer(const RenderScene& scene, const std::vector<std::vector<Vec3>>& normals,
                       const collision::RayScene& rays, const Camera& camera)
    : scene_(scene), normals_(normals), rays_(rays), camera_(camera), lighting_(camera)
{
    Bounds box;
    for (const RenderMesh& mesh : scene_.meshes)
        for (const Vec3& point : mesh.positions)
            box.extend(point);
    if (!box.empty()) {
        center_ = box.center();
        size_ = std::max(box.diagonal(), 1e-6);
    }
    step_off_ = kStepOff * size_;
    for (const RenderMesh& mesh : scene_.meshes)
        has_gaps_ = has_gaps_ || (mesh.paint && mesh.paint->has_gaps());

    sun_frame_ = frame_around(lighting_.to_sun);
}

PathSample PathTracer::trace(double x, double y, const PixelSampler& sampler, int sample) const
{
    const Vec3 direction = camera_.direction(x, y);
    const double height = std::clamp(0.5 + 0.5 * y, 0.0, 1.0);
    Vec3 background = kBackgroundHorizon + height * height * (kBackgroundTop - kBackgroundHorizon);

    // Distance to the floor along the ray, if it hits the floor from above.
    double t_ground = 1e30;
    if (scene_.ground_height && direction.y() < 0.0 && camera_.origin.y() > *scene_.ground_height)
        t_ground = (*scene_.ground_height - camera_.origin.y()) / direction.y();

    if (const auto hit = closest_hit(camera_.origin, direction, t_ground)) {
        const SurfacePoint at = surface_point(camera_.origin, direction, *hit);
        return {tone_map(shade(at, -direction, sampler, sample)), at.surface, at.position, at.normal,
                at.paint};
    }
    if (t_ground < 1e30) {
        const Vec3 at = camera_.origin + t_ground * direction;
        return {ground_color(at, background, sampler, sample), PathSample::kGround, at, Vec3::UnitY()};
    }
    return {.color = background};
}

SurfacePoint PathTracer::surface_point(const Vec3& origin, const Vec3& direction,
                                       const collision::RayHit& hit) const
{
    const RenderMesh& mesh = scene_.meshes[size_t(hit.mesh)];
    const std::vector<Vec3>& normals = normals_[size_t(hit.mesh)];
    const Triangle& corner = mesh.triangles[size_t(hit.triangle)];
    const Vec3 weight(1.0 - hit.u - hit.v, hit.u, hit.v);
    const auto position = [&](int k) -> const Vec3& { return mesh.positions[size_t(corner[k])]; };
    const Vec3 facet = (position(1) - position(0)).cross(position(2) - position(0)).normalized();
    const auto normal = [&](int k) -> const Vec3& {
        const Vec3& smooth = normals[size_t(corner[k])];
        return smooth.dot(facet) < kSharp ? facet : smooth;
    };

    SurfacePoint at;
    at.material = &mesh.material;
    at.position = origin + hit.t * direction;
    const bool is_front = facet.dot(direction) < 0.0;
    const double side = is_front ? 1.0 : -1.0;
    at.facet_normal = side * facet;
    at.normal = side * (weight[0] * normal(0) + weight[1] * normal(1) + weight[2] * normal(2));
    if (!(at.normal.norm() > 1e-9))
        at.normal = at.facet_normal;
    at.normal.normalize();

    // Shadow rays leave from the smooth surface that the corner normals describe; from the flat triangle the
    // edge between light and shade would follow the facets.                       [Hanika 2021, eq. 1]
    Vec3 lift = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        const double below = std::min(0.0, side * (at.position - position(k)).dot(normal(k)));
        lift -= weight[k] * below * side * normal(k);
    }
    at.shadow_origin = at.position + lift + step_off_ * at.facet_normal;

    at.surface = 1 + 3 * hit.mesh + (is_front ? 1 : 0);
    at.albedo = is_front ? mesh.material.front : mesh.material.back;
    if (mesh.paint)
        at.albedo = at.paint = paint_at(hit).value_or(at.albedo);
    else if (is_front && mesh.material.print != Print::Plain) {
        const std::array<Vec2, 3>& uv = mesh.corner_coordinates[size_t(hit.triangle)];
        if (second_color(mesh.material, weight[0] * uv[0] + weight[1] * uv[1] + weight[2] * uv[2])) {
            at.albedo = mesh.material.print_front;
            ++at.surface;
        }
    }
    return at;
}

Vec3 PathTracer::shade(const SurfacePoint& at, const Vec3& to_viewer, const PixelSampler& sampler,
                       int sample) const
{
    const Material& material = *at.material;
    const double facing = std::clamp(at.normal.dot(to_viewer), 0.0, 1.0);

    // Sky and neighbouring surfaces: two rays, because one has more noise than all other terms.
    const Vec3 sky = 0.5 * (sky_light(at.shadow_origin, at.normal, sampler.point(2 * sample, 1)) +
                            sky_light(at.shadow_origin, at.normal, sampler.point(2 * sample + 1, 1)));

    // Sun: diffuse on the lit side; fibres let some of it through to the other.
    const double sun_cosine = at.normal.dot(lighting_.to_sun);
    double lit = 0.0, through = 0.0, highlight = 0.0;
    const Vec2 random = sampler.point(sample, 2);
    if (sun_cosine > 0.0 && sun_reaches(at.shadow_origin, at.facet_normal, random)) {
        lit = sun_cosine;
        const double half_cosine = at.normal.dot((to_viewer + lighting_.to_sun).normalized());
        highlight = material.gloss * lit * std::pow(std::max(half_cosine, 0.0), 24.0);
    } else if (sun_cosine <= 0.0 && material.translucency > 0.0) {
        const Vec3 other_side = at.position - step_off_ * at.facet_normal;
        if (sun_reaches(other_side, -at.facet_normal, random))
            through = -material.translucency * sun_cosine;
    }

    // Sheen: fibres standing off the surface catch the light where it is seen edge-on.
    const double edge_on = (1.0 - facing) * (1.0 - facing) * (1.0 - facing);
    const Vec3 light = sky + (lit + through) * lighting_.sun;
    const Vec3 sheen_tint = material.sheen * edge_on * (0.5 * at.albedo + 0.5 * Vec3::Ones());
    return (at.albedo + sheen_tint).cwiseProduct(light) + highlight * lighting_.sun;
}

/// None in a gap of the paint.
std::optional<Vec3> PathTracer::paint_at(const collision::RayHit& hit) const
{
    return scene_.meshes[size_t(hit.mesh)].paint->colour(hit.triangle,
                                                         Vec3(1.0 - hit.u - hit.v, hit.u, hit.v));
}

/// Rays go on through gaps in paint.
std::optional<collision::RayHit> PathTracer::closest_hit(const Vec3& origin, const Vec3& direction,
                                                         double t_max) const
{
    auto hit = rays_.closest_hit(origin, direction, t_max);
    for (double passed = 0.0; has_gaps_ && hit;) {
        hit->t += passed;
        if (!scene_.meshes[size_t(hit->mesh)].paint || paint_at(*hit))
            break;
        passed = hit->t + step_off_;
        hit = rays_.closest_hit(origin + passed * direction, direction, t_max - passed);
    }
    return hit;
}

bool PathTracer::occluded(const Vec3& origin, const Vec3& direction, double t_max) const
{
    return has_gaps_ ? closest_hit(origin, direction, t_max).has_value()
                     : rays_.occluded(origin, direction, t_max);
}

Vec3 PathTracer::sky_light(const Vec3& from, const Vec3& normal, const Vec2& random) const
{
    const Vec3 direction = cosine_direction(normal, random);
    const auto hit = closest_hit(from, direction, 2.0 * size_);
    if (!hit)
        return lighting_.from(direction);
    const RenderMesh& mesh = scene_.meshes[size_t(hit->mesh)];
    const Vec3 albedo = mesh.paint ? paint_at(*hit).value_or(mesh.material.front) : mesh.material.front;
    return kBounce * albedo.cwiseProduct(lighting_.horizon);
}

bool PathTracer::sun_reaches(const Vec3& from, const Vec3& facet_normal, const Vec2& random) const
{
    const double radius = lighting_.sun_spread * std::sqrt(random.x());
    const double angle = 2.0 * std::numbers::pi * random.y();
    const Vec3 across = std::cos(angle) * sun_frame_.first + std::sin(angle) * sun_frame_.second;
    const Vec3 direction = (lighting_.to_sun + radius * across).normalized();
    return facet_normal.dot(direction) > -0.2 && !occluded(from, direction, 4.0 * size_);
}

Vec3 PathTracer::ground_color(const Vec3& at, const Vec3& background, const PixelSampler& sampler,
                              int sample) const
{
    const double distance = (at - center_).norm() / size_;
    const double s = std::clamp((distance - kFadeStart) / (kFadeEnd - kFadeStart), 0.0, 1.0);
    const double fade = s * s * (3.0 - 2.0 * s);
    if (fade == 1.0)
        return background;

    // Ratio of arriving light to that in the open.
    const Vec3 from = at + step_off_ * Vec3::UnitY();
    const Vec3 to_sky = cosine_direction(Vec3::UnitY(), sampler.point(sample, 1));
    const double sky = occluded(from, to_sky, 2.0 * size_) ? kHiddenSky : 1.0;
    const double sun = sun_reaches(from, Vec3::UnitY(), sampler.point(sample, 2)) ? 1.0 : 0.0;
    const Vec3 sky_part = 0.5 * (lighting_.zenith + lighting_.horizon);
    const Vec3 sun_part = lighting_.to_sun.y() * lighting_.sun;
    const Vec3 ratio = (sky * sky_part + sun * sun_part).cwiseQuotient(sky_part + sun_part);

    const Vec3 floor = kFloor + fade * (background - kFloor);
    const double relief = kShadowRelief + fade * (1.0 - kShadowRelief);
    return floor.cwiseProduct(ratio + relief * (Vec3::Ones() - ratio));
}

} // namespace toile::preview
