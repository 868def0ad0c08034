#pragma once

#include "core/compute/types.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

class DeviceSolver;

/// The global step of Projective Dynamics: an exact or approximate inverse of the constant matrix H, the same
/// for x, y and z.
class GlobalSolver {
public:
    virtual ~GlobalSolver() = default;

    /// Prepares for H. If only values changed since the last call, data of the pattern are kept.
    /// @param H      [n x n] symmetric positive definite, compressed
    /// @param fixed  [n] 1 if row and column of H are the identity's
    /// @throws InvalidInput if H is not positive definite
    virtual void update(const SparseMatrix& H, View<const unsigned char> fixed) = 0;

    /// Called before every step, after any update(). Only here and in update() may the operator behind
    /// solve() change.
    virtual void begin_step() {}

    /// x = H^-1 b, or close to it; linear in b unless the solver says otherwise. The same bits for every
    /// thread count.
    /// @param b, x  [n]; may be the same array
    virtual void solve(View<const Vec3> b, View<Vec3> x) const = 0;

    /// False if a . solve(b) and b . solve(a) may differ: conjugate gradients then need their flexible form.
    virtual bool is_symmetric() const = 0;

    /// This solver if its operator lives on a GPU, or null.
    virtual DeviceSolver* on_device() { return nullptr; }
};

} // namespace toile
