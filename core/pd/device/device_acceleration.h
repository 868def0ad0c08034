#pragma once

#include "core/backend/types.h"

namespace toile {

/// What accelerates the vertices of a body on a GPU from outside, from where the body has them.
class DeviceAcceleration {
public:
    virtual ~DeviceAcceleration() = default;

    /// Enqueues the acceleration of a step of dt [s]. All fields are the device's.
    /// @param x, v          [vertices] at the start of the step [m], [m/s]
    /// @param acceleration  [vertices] overwritten [m/s^2]
    virtual void accelerate(double dt, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration) = 0;
};

} // namespace toile
