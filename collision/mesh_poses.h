#pragma once

#include <memory>

#include "core/backend/cuda/array.h"

namespace toile {

/// Works out on a GPU where a mesh is at both ends of the current step, which then stays there. Enqueues.
class DeviceMeshPoses {
public:
    virtual ~DeviceMeshPoses() = default;
    virtual void pose_t0(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
    virtual void pose_t1(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
};

/// Works out where a mesh is at both ends of the current step.
class MeshPoses {
public:
    virtual ~MeshPoses() = default;
    virtual int vertex_count() const = 0;
    virtual void pose_t0(View<Vec3> x) const = 0; ///< [vertices] out [m]
    virtual void pose_t1(View<Vec3> x) const = 0; ///< [vertices] out [m]

    /// The same on a GPU. Borrows this and the space.
    virtual std::unique_ptr<DeviceMeshPoses> on_device(const CudaSpace& space) const = 0;
};

} // namespace toile
