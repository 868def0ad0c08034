#pragma once

#include <functional>

#include "core/backend/types.h"

namespace toile {

class CudaSpace;
class DeviceStepProjection;

/// A hard constraint applied after the minimisation of a step, outside H: limits that would need weights far
/// above the rest of H (strain limits) stall every method that inverts a fixed H.
class StepProjection {
public:
    virtual ~StepProjection() = default;

    /// Looks at the minimiser of the step before anything moves it.
    virtual void observe(View<const Vec3> x) = 0;

    /// Moves x [vertices] onto the constraint, vertices with weight 0 not at all.
    /// @param inverse_masses  [vertices] [1/kg], 0 for fixed vertices
    /// @param clear_contacts  to be called while projecting, so that contact is respected: moves x, false
    ///                        only where nothing has moved; may be empty
    virtual void project(View<Vec3> x, View<const double> inverse_masses,
                         const std::function<bool()>& clear_contacts) = 0;

    /// The same for a body on a GPU; null where it has no such form.
    virtual DeviceStepProjection* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }
};

} // namespace toile
