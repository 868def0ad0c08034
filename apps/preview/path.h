#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "apps/preview/camera.h"
#include "apps/preview/lighting.h"
#include "apps/preview/render_scene.h"
#include "apps/preview/sampler.h"
#include "collision/bvh/ray_scene.h"

namespace toile::preview {

/// Hit point of a ray with its shading data.
struct SurfacePoint {
    Vec3 position = Vec3::Zero();      ///< [m]
    Vec3 shadow_origin = Vec3::Zero(); ///< [m] where shadow rays start, see PathTracer::surface_point
    Vec3 normal = Vec3::UnitY();       ///< smooth, on the viewer's side, unit
    Vec3 facet_normal = Vec3::UnitY(); ///< of the triangle, on the viewer's side, unit
    Vec3 albedo = Vec3::Zero();        ///< linear RGB
    Vec3 paint = Vec3::Zero();         ///< the same, if the mesh has paint
    const Material* material = nullptr;
    int surface = 0; ///< PathSample::surface
};

/// Colour of one path, and what its camera ray met.
struct PathSample {
    Vec3 color = Vec3::Zero();    ///< display-linear [0, 1]
    int surface = kBackground;    ///< a side of a mesh, or a colour of its print
    Vec3 position = Vec3::Zero(); ///< [m]
    Vec3 normal = Vec3::Zero();   ///< smooth, on the viewer's side, unit
    Vec3 paint = Vec3::Zero();    ///< linear RGB, if the mesh has paint

    static constexpr int kBackground = -1, kGround = 0;
};

/// Traces light paths of length two: camera, surface, then sun, sky or a neighbouring surface.
class PathTracer {
public:
    /// Keeps references to all arguments.
    PathTracer(const RenderScene& scene, const std::vector<std::vector<Vec3>>& normals,
               const collision::RayScene& rays, const Camera& camera);

    /// One sample at picture coordinates in [-1, 1].
    PathSample trace(double x, double y, const PixelSampler& sampler, int sample) const;

private:
    SurfacePoint surface_point(const Vec3& origin, const Vec3& direction, const collision::RayHit& hit) const;
    Vec3 shade(const SurfacePoint& at, const Vec3& to_viewer, const PixelSampler& sampler, int sample) const;
    Vec3 ground_color(const Vec3& at, const Vec3& background, const PixelSampler& sampler, int sample) const;
    Vec3 sky_light(const Vec3& from, const Vec3& normal, const Vec2& random) const;
    std::optional<Vec3> paint_at(const collision::RayHit& hit) const;
    std::optional<collision::RayHit> closest_hit(const Vec3& origin, const Vec3& direction,
                                                 double t_max) const;
    bool occluded(const Vec3& origin, const Vec3& direction, double t_max) const;
    bool sun_reaches(const Vec3& from, const Vec3& facet_normal, const Vec2& random) const;

    const RenderScene& scene_;
    const std::vector<std::vector<Vec3>>& normals_;
    const collision::RayScene& rays_;
    const Camera& camera_;
    Lighting lighting_;
    std::pair<Vec3, Vec3> sun_frame_; ///< unit, across the direction to the sun
    Vec3 center_ = Vec3::Zero();      ///< of all meshes [m]
    double size_ = 1.0;               ///< diagonal of all meshes [m]
    bool has_gaps_ = false;           ///< in the paint of any mesh
    double step_off_ = 1e-5;          ///< [m] start of secondary rays above the surface they leave
};

} // namespace toile::preview
