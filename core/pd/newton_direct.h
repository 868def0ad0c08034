#pragma once

#include <memory>

#include "core/linear/cholesky.h"
#include "core/pd/outer_loop.h"

namespace toile {

/// Newton's method with a Cholesky factor of the whole Hessian [3n x 3n]: for references that must have
/// converged. The exact Hessian where it is positive definite, which converges quadratically; the projected
/// one elsewhere. A step costs 20 to 50 of L-BFGS's. Not for objectives with an active set, whose share the
/// factor would lack.
class NewtonDirect : public OuterLoop {
public:
    /// g . K^-1 g of the last step, twice the decrease that Newton's method still expects [J].
    double decrement() const { return decrement_; }

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;

private:
    void factor(Hessian& hessian, View<const Vec3> x);

    std::unique_ptr<Cholesky> cholesky_; ///< kept within a call: the pattern is the objective's
    std::vector<Vec3> numbers_; ///< [3 vertices] scratch: the solver takes 3-vectors, one lane is used
    double decrement_ = 0.0;
};

} // namespace toile
