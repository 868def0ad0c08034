#pragma once

#include "core/backend/cuda/device.h"
#include "core/linear/global_solver.h"

namespace toile {

/// A global solver whose operator lives on a GPU.
class DeviceSolver : public GlobalSolver {
public:
    /// Where it runs.
    virtual const CudaSpace& space() const = 0;

    /// Enqueues x = H^-1 b, or close to it. What it launches may be recorded, and is valid until the next
    /// update().
    /// @param b, x  [n] on the device; not the same array
    virtual void solve_there(View<const Vec3> b, View<Vec3> x) = 0;
};

} // namespace toile
