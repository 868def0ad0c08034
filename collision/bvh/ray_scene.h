#pragma once

#include <memory>
#include <optional>

#include "core/compute/types.h"

namespace toile::collision {

/// Intersection of a ray with a triangle, at the point (1 - u - v) x0 + u x1 + v x2.
struct RayHit {
    int mesh = -1;     ///< as returned by RayScene::add
    int triangle = -1; ///< of that mesh
    double u = 0.0;    ///< weight of corner 1 [-]
    double v = 0.0;    ///< weight of corner 2 [-]
    double t = 0.0;    ///< ray parameter: point = origin + t * direction
};

/// Ray queries on triangle meshes, with Embree's BVH.
///
/// Positions are rounded to single precision, so t and the weights carry a relative error of about 1e-6. Rays
/// do not leak through shared edges and vertices (watertight intersection, [Woop et al. 2013]); both sides of
/// a triangle are hit. Queries may run on any number of threads at once, changes on one.
class RayScene {
public:
    RayScene();
    ~RayScene();
    RayScene(RayScene&&) noexcept;
    RayScene& operator=(RayScene&&) noexcept;

    /// Copies a mesh into the scene. It takes part in queries from the next commit() on.
    /// @param positions  [vertices x 3] [m]
    /// @param triangles  [triangles x 3] indices into positions
    /// @return 0, 1, 2, ... in order of calls
    /// @throws std::bad_alloc if Embree lacks memory, here and in commit()
    int add(View<const Vec3> positions, View<const Triangle> triangles);

    /// Moves a mesh to new positions [vertices x 3] [m]: the tree keeps its topology and is refitted. O(n).
    /// Takes effect at the next commit().
    void update(int mesh, View<const Vec3> positions);

    /// Builds the trees of new meshes and refits those of updated ones. Must precede queries.
    void commit();

    /// Hit with the smallest t in (0, t_max), or nothing.
    std::optional<RayHit> closest_hit(const Vec3& origin, const Vec3& direction, double t_max) const;

    /// True if any triangle is hit at t in (0, t_max). Cheaper than closest_hit.
    bool occluded(const Vec3& origin, const Vec3& direction, double t_max) const;

    /// Number of triangles that an unbounded ray meets, however near each other.
    int hit_count(const Vec3& origin, const Vec3& direction) const;

    /// Winding number of closed meshes around a point: 0 outside, 1 inside, 2 where two parts of a
    /// self-intersecting body overlap, -1 inside a mesh turned inside out. It equals exits minus entries
    /// along a ray. The majority of three fixed directions decides, because a grazing ray can miscount.
    /// Undefined within about 1e-6 m of the surface and for open meshes.
    int winding_number(const Vec3& point) const;

private:
    struct Trees;
    std::unique_ptr<Trees> trees_;
};

} // namespace toile::collision
