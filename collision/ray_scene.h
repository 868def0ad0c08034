#pragma once

#include <memory>
#include <optional>

#include "core/backend/types.h"

namespace toile {

/// Where a ray meets a triangle. The point is (1 - u - v) x0 + u x1 + v x2.
struct RayHit {
    int mesh = -1;     ///< as returned by RayScene::add
    int triangle = -1; ///< of that mesh
    double u = 0.0;    ///< weight of corner 1 [-]
    double v = 0.0;    ///< weight of corner 2 [-]
    double t = 0.0;    ///< ray parameter: point = origin + t * direction
};

/// Triangle meshes that answer ray queries, on Embree's BVH.
///
/// Positions are rounded to single precision, so t and the weights carry a relative error of about 1e-6.
/// Rays do not leak through shared edges and vertices (watertight intersection, [Woop et al. 2013]); both
/// sides of a triangle are hit. Queries may run on any number of threads at once, changes on one.
class RayScene {
public:
    RayScene();
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    /// Copies a mesh into the scene. Takes part in queries from the next commit() on.
    /// @param positions  [vertices x 3] [m]
    /// @param triangles  [triangles x 3] indices into positions
    /// @return 0, 1, 2, ... in order of calls
    int add(View<const Vec3> positions, View<const Triangle> triangles);

    /// Moves a mesh to new positions [vertices x 3] [m]: the tree keeps its shape and gets new boxes, O(n).
    /// Takes effect at the next commit().
    void update(int mesh, View<const Vec3> positions);

    /// Builds the trees of new meshes, refits those of updated ones. Must precede queries.
    void commit();

    /// The first triangle in t of (0, t_max), or nothing.
    std::optional<RayHit> closest_hit(const Vec3& origin, const Vec3& direction, double t_max) const;

    /// True when any triangle lies in t of (0, t_max). Cheaper than closest_hit.
    bool occluded(const Vec3& origin, const Vec3& direction, double t_max) const;

    /// How often the surfaces wind around a point, for closed meshes: 0 outside, 1 inside, 2 where two parts
    /// of a self-intersecting body overlap, -1 inside a mesh that is turned inside out. Exits minus entries
    /// along a ray; the majority of three fixed directions decides, because a ray that grazes a
    /// surface can miscount. Undefined within about 1e-6 m of the surface and for open meshes.
    int winding_number(const Vec3& point) const;

private:
    struct Trees;
    std::unique_ptr<Trees> trees_;
};

} // namespace toile
