#pragma once

#include "core/backend/types.h"

namespace toile {

class Curvature;

/// A smooth function of a 3-vector field together with an approximate inverse of its Hessian.
class Objective {
public:
    virtual ~Objective() = default;

    /// Value at x [J]; gradient [N] is overwritten.
    virtual double evaluate(View<const Vec3> x, View<Vec3> gradient) = 0;

    /// z = B g with B symmetric positive definite and close to the inverse Hessian at the last accepted
    /// point.
    virtual void precondition(View<const Vec3> g, View<Vec3> z) = 0;

    /// Called at every accepted point, before the next precondition().
    virtual void accept(View<const Vec3> x) = 0;

    /// True when the point with this gradient is the minimiser for all that matters.
    /// @param move       that the method wants next, no longer than the tolerance anywhere [m]
    /// @param tolerance  [m]
    virtual bool is_minimiser([[maybe_unused]] View<const Vec3> gradient,
                              [[maybe_unused]] View<const Vec3> move, [[maybe_unused]] double tolerance) const
    {
        return true;
    }
};

} // namespace toile
