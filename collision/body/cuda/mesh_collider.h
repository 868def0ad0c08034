#pragma once

#include "collision/geometry/cuda/surface.h"
#include "collision/geometry/cuda/surface_search.h"

namespace toile::collision {

/// Search structure of a surface at the positions x [vertices x 3] [m] of its last move.
inline SurfaceSearch search_of(const DeviceSurface& surface, View<const Vec3> x)
{
    return {{surface.triangles(), x, surface.edges()},
            surface.triangle_tree(),
            surface.edge_tree(),
            surface.extent()};
}

/// MeshCollider on a GPU: a triangle surface that cloth may contact, at the end t1 of the current step.
class DeviceMeshCollider {
public:
    /// @param space      borrowed
    /// @param triangles  [triangles x 3] any list, on the host
    /// @param positions  [vertices x 3] [m] first pose, on the host: orders the trees
    DeviceMeshCollider(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions)
        : surface_(space, triangles, positions)
    {
    }

    /// Sets the step's positions [vertices x 3] [m] on the device, borrowed until the next move. Enqueues a
    /// refit of the boxes at t1.
    void move(View<const Vec3> x_t0, View<const Vec3> x_t1)
    {
        x_t0_ = x_t0;
        x_t1_ = x_t1;
        surface_.move(x_t1, {}, 0.0);
    }

    const DeviceSurface& surface() const { return surface_; }
    View<const Vec3> x_t0() const { return x_t0_; }
    SurfaceSearch search() const { return search_of(surface_, x_t1_); } ///< at t1

private:
    DeviceSurface surface_;
    View<const Vec3> x_t0_, x_t1_;
};

} // namespace toile::collision
