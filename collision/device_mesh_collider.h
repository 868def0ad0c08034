#pragma once

#include "collision/device_surface.h"
#include "collision/surface_search.h"

namespace toile {

/// A surface at the positions x [vertices x 3] [m] that it was last moved to.
inline SurfaceSearch search_of(const DeviceSurface& surface, View<const Vec3> x)
{
    return {{surface.triangles(), x, surface.edges()},
            surface.triangle_tree(),
            surface.edge_tree(),
            surface.extent()};
}

/// MeshCollider on a GPU: a triangle surface that cloth may touch, at the end t1 of the current step.
class DeviceMeshCollider {
public:
    /// @param space      borrowed
    /// @param triangles  [triangles x 3] any list, of the host
    /// @param positions  [vertices x 3] [m] the first pose, of the host: orders the trees
    DeviceMeshCollider(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions)
        : surface_(space, triangles, positions)
    {
    }

    /// Enqueues: the step's positions [vertices x 3] [m] on the device, borrowed until the next move; boxes
    /// around those at t1.
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

} // namespace toile
