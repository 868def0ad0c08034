#pragma once

#include "collision/bvh/motion_bounds.h"
#include "core/compute/cuda/array.h"

namespace toile::collision {

/// MotionBounds on a GPU, with the same bits. All views are on the device.
class DeviceMotionBounds {
public:
    /// @param space  borrowed
    explicit DeviceMotionBounds(const CudaSpace& space);

    /// Enqueues the computation. Parameters as in MotionBounds::build; `box` is passed by value from the
    /// host.
    void build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
               const Bounds& box);

    MotionView view() const { return {grid_, motion_.view()}; } ///< borrowed until the next build()

private:
    const CudaSpace& space_;
    CellGrid grid_;
    DeviceArray<CellGrid::Cell> cell_of_;      ///< [vertices]
    DeviceArray<Bounds> cell_bounds_, motion_; ///< [cells] see MotionBounds [m]
};

} // namespace toile::collision
