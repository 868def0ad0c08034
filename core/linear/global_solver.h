#pragma once

#include "core/backend/types.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// The global step of Projective Dynamics: an exact or approximate inverse of the constant matrix H, the same
/// for x, y and z.
class GlobalSolver {
public:
    virtual ~GlobalSolver() = default;

    /// Prepares for H. Where only values changed since the last call, what depends on the pattern is kept.
    /// @param H      [n x n] symmetric positive definite, compressed
    /// @param fixed  [n] 1 where row and column of H are the identity's
    /// @throws InvalidInput where H is not positive definite
    virtual void update(const SparseMatrix& H, View<const unsigned char> fixed) = 0;

    /// Called before every step, after update() where that is due: the only place, besides update(), where
    /// the operator behind solve() may change.
    virtual void begin_step() {}

    /// x = H^-1 b, or close to it; linear in b unless the solver says otherwise. Same bits for every thread
    /// count.
    /// @param b, x  [n]; may be the same array
    virtual void solve(View<const Vec3> b, View<Vec3> x) const = 0;

    /// False when a . solve(b) and b . solve(a) may differ: conjugate gradients then need their flexible
    /// form.
    virtual bool is_symmetric() const = 0;
};

} // namespace toile
