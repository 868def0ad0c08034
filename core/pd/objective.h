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
};

} // namespace toile
