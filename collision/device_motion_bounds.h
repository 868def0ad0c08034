#pragma once

#include "collision/motion_bounds.h"
#include "core/backend/cuda/array.h"

namespace toile {

/// MotionBounds on a GPU: the same bits. All views are the device's.
class DeviceMotionBounds {
public:
    /// @param space  borrowed
    explicit DeviceMotionBounds(const CudaSpace& space);

    /// Enqueues. Parameters as MotionBounds::build's; the box is the host's.
    void build(View<const Triangle> triangles, View<const Vec3> before, View<const Vec3> now,
               const Bounds& box);

    MotionView view() const { return {grid_, motion_.view()}; } ///< borrowed until the next build()

private:
    const CudaSpace& space_;
    CellGrid grid_;
    DeviceArray<CellGrid::Cell> cell_of_; ///< [vertices]
    DeviceArray<Bounds> own_, motion_;    ///< [cells] see MotionBounds [m]
};

} // namespace toile
