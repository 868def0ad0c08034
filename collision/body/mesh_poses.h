#pragma once

#include <memory>

#include "core/compute/types.h"

namespace toile {
class CudaSpace;
template <typename T>
class DeviceArray;
} // namespace toile

namespace toile::collision {

/// Evaluates a mesh's positions at both ends of the current step on a GPU, where they stay. Enqueues. The
/// arrays already have the mesh's size.
class DeviceMeshPoses {
public:
    virtual ~DeviceMeshPoses() = default;
    // @throws DeviceError if a launch or a copy is refused
    virtual void pose_t0(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
    virtual void pose_t1(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
};

/// Evaluates a mesh's positions at both ends of the current step. The poses advance together with the step of
/// their MeshCollider and stay until the next. Any thread may call.
class MeshPoses {
public:
    virtual ~MeshPoses() = default;
    virtual int vertex_count() const = 0;
    virtual void pose_t0(View<Vec3> x) const = 0; ///< [vertices] out [m]
    virtual void pose_t1(View<Vec3> x) const = 0; ///< [vertices] out [m]

    /// Evaluator of the poses on a GPU. Borrows this and the space.
    virtual std::unique_ptr<DeviceMeshPoses> on_device(const CudaSpace& space) const = 0;
};

} // namespace toile::collision
