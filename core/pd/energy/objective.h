#pragma once

#include "core/linear/sparse_matrix.h"
#include "core/pd/energy/energy.h"
#include "core/pd/energy/frozen_hessian.h"

namespace toile {

/// Entries of a Hessian, for preconditioners that are built from them. Rows and columns of fixed vertices are
/// the identity's, whatever stands here.
struct HessianParts {
    View<const unsigned char> fixed; ///< [vertices]
    View<const double> inertia;      ///< [vertices] on the diagonal of x, y and z [N/m]
    const SparseMatrix& isotropic;   ///< [vertices x vertices] the same for x, y and z [N/m]
    const BlockMatrix& blocks;       ///< [N/m]
    View<const Mat3> diagonal;       ///< [vertices] all of these on the diagonal, or a bound [N/m]
    std::vector<FrozenTerm> terms;   ///< of an active set
    const FrozenHessian* whole_set;  ///< the active set, if its terms are not all of it; null: they are
};

/// Hessian K of an objective, for Newton's method.
class Hessian {
public:
    virtual ~Hessian() = default;

    /// Evaluates K at x, the last accepted point.
    virtual void linearise(View<const Vec3> x, Definiteness definiteness) = 0;

    /// Computes out = K p [N].
    virtual void multiply(View<const Vec3> p, View<Vec3> out) = 0;

    /// Computes out = K p without the part of an active set [N].
    virtual void multiply_without_active_set(View<const Vec3> p, View<Vec3> out) { multiply(p, out); }

    /// Takes over another frozen Hessian of the active set; the rest stays.
    virtual void update_active_set() {}

    /// 3 x 3 blocks on the diagonal, or bounds on them: positive definite when projected. [vertices]
    virtual View<const Mat3> diagonal_blocks() const = 0;

    /// K as a matrix of numbers [3 vertices x 3 vertices], coordinates of a vertex adjacent, without the part
    /// of an active set.
    virtual SparseMatrix matrix() const = 0;

    /// Entries after linearise(); borrowed until the next.
    virtual HessianParts parts() const = 0;
};

/// Smooth function of a 3-vector field together with an approximate inverse of its Hessian.
class Objective {
public:
    virtual ~Objective() = default;

    /// Value at x [J]; gradient [N] is overwritten.
    virtual double evaluate(View<const Vec3> x, View<Vec3> gradient) = 0;

    /// Computes z = B g with B symmetric positive definite and close to the inverse Hessian at the last
    /// accepted point.
    virtual void precondition(View<const Vec3> g, View<Vec3> z) = 0;

    /// Applies the linear part of B, constant between accepted points: a preconditioner for CG. It may omit
    /// an active set.
    virtual void precondition_linearly(View<const Vec3> g, View<Vec3> z) { precondition(g, z); }

    /// Called at every accepted point, before the next precondition().
    virtual void accept(View<const Vec3> x) = 0;

    /// Null if the objective has no second derivatives.
    virtual Hessian* hessian() { return nullptr; }

    /// True if the point with this gradient counts as the minimiser.
    /// @param move       next displacement of the method, nowhere longer than the tolerance [m]
    /// @param tolerance  [m]
    virtual bool is_minimiser([[maybe_unused]] View<const Vec3> gradient,
                              [[maybe_unused]] View<const Vec3> move, [[maybe_unused]] double tolerance) const
    {
        return true;
    }

    /// Minimum gain of several iterations together, from the last accepted point on, below which the loop
    /// stops [J]; 0: no such limit.
    /// @param tolerance  [m]
    virtual double negligible_gain([[maybe_unused]] double tolerance) const { return 0.0; }
};

} // namespace toile
