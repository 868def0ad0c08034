#pragma once

#include <memory>

#include "core/backend/types.h"

namespace toile {

class CudaSpace;
template <typename T>
class DeviceArray;

/// Works out on a GPU where a mesh is at both ends of the current step, which then stays there. Enqueues.
/// Arrays have the size of the mesh already.
class DeviceMeshPoses {
public:
    virtual ~DeviceMeshPoses() = default;
    // @throws DeviceError where a launch or a copy is refused
    virtual void pose_t0(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
    virtual void pose_t1(DeviceArray<Vec3>& x) = 0; ///< [vertices] out [m]
};

/// Works out where a mesh is at both ends of the current step. The poses change together with the step of the
/// MeshCollider that has them and stay until the next; any thread may ask.
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
