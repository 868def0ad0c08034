#pragma once

#include "core/backend/cuda/array.h"
#include "core/linear/global_solver.h"

namespace toile {

/// A global solver whose operator lives on a GPU.
class DeviceSolver : public GlobalSolver {
public:
    /// @param space  where it runs, borrowed
    explicit DeviceSolver(const CudaSpace& space);

    const CudaSpace& space() const { return space_; }

    /// Enqueues x = H^-1 b, or close to it. What it launches may be recorded, and is valid until the next
    /// update().
    /// @param b, x  [n] on the device; not the same array
    virtual void solve_there(View<const Vec3> b, View<Vec3> x) const = 0;

    /// The same of fields on the host: copies there and back.
    void solve(View<const Vec3> b, View<Vec3> x) const final;

    bool is_symmetric() const final { return false; }

private:
    const CudaSpace& space_;
    mutable DeviceArray<Vec3> b_, x_; ///< of solve()
};

} // namespace toile
