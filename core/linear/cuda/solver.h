#pragma once

#include "core/compute/cuda/array.h"
#include "core/linear/global_solver.h"

namespace toile {

class DeviceQuadratureSolver;

/// Global solver whose operator lives on a GPU.
class DeviceSolver : public GlobalSolver {
public:
    /// @param space  on which it runs, borrowed
    explicit DeviceSolver(const CudaSpace& space);

    const CudaSpace& space() const { return space_; }

    /// Enqueues x = H^-1 b, or close to it. Its launches may be recorded; a recording is valid until the next
    /// update().
    /// @param b, x  [n] on the device; not the same array
    virtual void solve_on_device(View<const Vec3> b, View<Vec3> x) const = 0;

    /// Solves for fields on the host: copies them to the device and back.
    void solve(View<const Vec3> b, View<Vec3> x) const final;

    bool is_symmetric() const final { return false; }

    DeviceSolver* on_device() final { return this; }

    /// This solver if kernels of a caller can be part of its own (DeviceQuadratureSolver::begin_solve), or
    /// null.
    virtual DeviceQuadratureSolver* as_quadrature() { return nullptr; }

private:
    const CudaSpace& space_;
    mutable DeviceArray<Vec3> b_, x_; ///< of solve()
};

} // namespace toile
