#pragma once

#include "core/compute/types.h"

namespace toile {

/// External acceleration of a body's vertices, computed on a GPU.
class DeviceAcceleration {
public:
    virtual ~DeviceAcceleration() = default;

    /// Enqueues the acceleration of a step of dt [s]. All fields are on the device.
    /// @param x, v          [vertices] at the start of the step [m], [m/s]
    /// @param acceleration  [vertices] overwritten [m/s^2]
    virtual void accelerate(double dt, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration) = 0;
};

} // namespace toile
