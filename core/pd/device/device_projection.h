#pragma once

#include <functional>

#include "core/backend/types.h"

namespace toile {

/// A hard constraint applied after the minimisation of a step on a GPU: what StepProjection is on the CPU.
/// What looks at the minimiser there is DeviceEnergy::end_minimisation() here.
class DeviceStepProjection {
public:
    virtual ~DeviceStepProjection() = default;

    /// True where project() would move nothing. Waits.
    virtual bool is_satisfied(View<const Vec3> x) = 0;

    /// Moves x onto the constraint, vertices with weight 0 not at all. Waits to see whether anything is left
    /// to do. Arrays are the device's.
    /// @param x               [vertices] of which is_satisfied() has just said no [m]
    /// @param inverse_masses  [vertices] [1/kg], 0 for fixed vertices
    /// @param clear_contacts  as StepProjection's: to be called while projecting, moves x in the stream's
    ///                        turn, false only where nothing will move; may be empty
    virtual void project(View<Vec3> x, View<const double> inverse_masses,
                         const std::function<bool()>& clear_contacts) = 0;

    /// Enqueues what is to be told of the positions x [vertices] [m] that a step has ended with. The body
    /// waits after it.
    virtual void end_step([[maybe_unused]] View<const Vec3> x) {}
};

} // namespace toile
