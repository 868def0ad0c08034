#pragma once

#include <functional>

#include "core/compute/types.h"

namespace toile {

class CudaSpace;
class DeviceStepProjection;

/// Hard constraint applied after the minimisation of a step, outside H. Limits that need weights far above
/// the rest of H (strain limits) stall every method that inverts a fixed H.
class StepProjection {
public:
    virtual ~StepProjection() = default;

    /// Observes the minimiser of the step before any correction moves it.
    virtual void observe(View<const Vec3> x) = 0;

    /// Moves x [vertices] onto the constraint, except vertices with weight 0.
    /// @param inverse_masses  [vertices] [1/kg], 0 for fixed vertices
    /// @param clear_contacts  to be called while projecting, so that contact is respected: moves x, false
    ///                        only if nothing has moved; may be empty
    virtual void project(View<Vec3> x, View<const double> inverse_masses,
                         const std::function<bool()>& clear_contacts) = 0;

    /// GPU counterpart; null if there is none.
    virtual DeviceStepProjection* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }
};

} // namespace toile
