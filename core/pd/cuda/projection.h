#pragma once

#include <functional>

#include "core/compute/types.h"

namespace toile {

/// Hard constraint applied after the minimisation of a step on a GPU: counterpart of StepProjection. Its
/// observe() corresponds to DeviceEnergy::end_minimisation().
class DeviceStepProjection {
public:
    virtual ~DeviceStepProjection() = default;

    /// True if project() would move nothing. Waits.
    virtual bool is_satisfied(View<const Vec3> x) = 0;

    /// Moves x onto the constraint, except vertices with weight 0. Waits to find out whether anything remains
    /// to be done. Arrays are on the device.
    /// @param x               [vertices] for which is_satisfied() has just returned false [m]
    /// @param inverse_masses  [vertices] [1/kg], 0 for fixed vertices
    /// @param clear_contacts  as StepProjection's: to be called while projecting, moves x in stream order,
    ///                        false only if nothing will move; may be empty
    virtual void project(View<Vec3> x, View<const double> inverse_masses,
                         const std::function<bool()>& clear_contacts) = 0;

    /// Enqueues the report on the final positions x [vertices] [m] of a step. The body waits after it.
    virtual void end_step([[maybe_unused]] View<const Vec3> x) {}
};

} // namespace toile
