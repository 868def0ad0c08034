#include "apps/preview/value_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "collision/bvh/ray_scene.h"
#include "core/compute/parallel.h"

namespace toile::preview {

namespace {

/// Rays of a pixel [pixels]: a rotated grid, which smooths upright and level edges best.
const std::array<Vec2, 4> kRays{Vec2(0.375, 0.125), Vec2(0.875, 0.375), Vec2(0.125, 0.625),
                                Vec2(0.625, 0.875)};
/// sRGB.
const Vec3 kBackground(0.98, 0.98, 0.98), kGrey(0.86, 0.85, 0.84);
/// Brightness [-] of what is seen edge on; 1 faces the camera.
constexpr double kEdgeOn = 0.6;
constexpr double kFarthestHit = 1e6; ///< [m]

} // namespace

ValueView::ValueView(const TriangleMesh& surface, const TriangleMesh& around, const Camera& camera, int width,
                     int height)
    : width_(width), height_(height), triangles_(surface.triangles),
      samples_(size_t(width) * size_t(height) * kRays.size())
{
    const std::array<const TriangleMesh*, 2> meshes{&surface, &around};
    std::array<std::vector<Vec3>, 2> normals;
    collision::RayScene rays;
    for (size_t m = 0; m < meshes.size(); ++m) {
        normals[m] = vertex_normals(meshes[m]->positions, meshes[m]->triangles);
        if (!meshes[m]->triangles.empty())
            rays.add(meshes[m]->positions, meshes[m]->triangles);
    }
    rays.commit();
    parallel_for(kCpu, "value_view/rays", int(samples_.size()), [&](int i) {
        const int pixel = i / int(kRays.size());
        const Vec2& at = kRays[size_t(i) % kRays.size()];
        const Vec2 seen =
            camera.picture_coordinates((pixel % width + at.x()) / width, (pixel / width + at.y()) / height);
        const Vec3 direction = camera.direction(seen.x(), seen.y());
        const auto hit = rays.closest_hit(camera.origin, direction, kFarthestHit);
        if (!hit)
            return;
        const Triangle& t = meshes[size_t(hit->mesh)]->triangles[size_t(hit->triangle)];
        const std::vector<Vec3>& normal = normals[size_t(hit->mesh)];
        const Vec3 n = (1.0 - hit->u - hit->v) * normal[size_t(t[0])] + hit->u * normal[size_t(t[1])] +
                       hit->v * normal[size_t(t[2])];
        const double facing = std::abs(direction.dot(n)) / std::max(n.norm(), 1e-12);
        samples_[size_t(i)] = {hit->mesh == 0 ? hit->triangle : kAround, float(hit->u), float(hit->v),
                               float(kEdgeOn + (1.0 - kEdgeOn) * facing)};
    });
}

Vec3 ValueView::colour(const Sample& sample, View<const double> values, const ColourScale& scale) const
{
    if (sample.triangle == kNothing)
        return kBackground;
    if (sample.triangle == kAround)
        return sample.brightness * kGrey;
    const Triangle& t = triangles_[size_t(sample.triangle)];
    const double u = sample.u, v = sample.v;
    return sample.brightness *
           scale.colour((1.0 - u - v) * values[t[0]] + u * values[t[1]] + v * values[t[2]]);
}

Image ValueView::picture(View<const double> values, const ColourScale& scale) const
{
    Image image(width_, height_);
    parallel_for(kCpu, "value_view/pixels", width_ * height_, [&](int pixel) {
        Vec3 sum = Vec3::Zero();
        for (size_t k = 0; k < kRays.size(); ++k)
            sum += colour(samples_[size_t(pixel) * kRays.size() + k], values, scale);
        for (int channel = 0; channel < 3; ++channel)
            image.pixel(pixel % width_, pixel / width_)[channel] =
                std::uint8_t(std::lround(255.0 * sum[channel] / double(kRays.size())));
    });
    return image;
}

} // namespace toile::preview
