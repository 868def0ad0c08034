#pragma once

#include <memory>

#include "core/linear/cholesky.h"
#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Newton's method with a Cholesky factor of the whole Hessian [3n x 3n], for converged reference solutions.
/// Uses the exact Hessian if it is positive definite, which converges quadratically, else the projected one.
/// A step costs as much as 20 to 50 of L-BFGS. Not for objectives with an active set, whose part the factor
/// would lack.
class NewtonDirect : public OuterLoop {
public:
    /// g . K^-1 g of the last step, twice the decrease that Newton's method still expects [J].
    double decrement() const { return decrement_; }

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;

private:
    void factor(Hessian& hessian, View<const Vec3> x);

    std::unique_ptr<Cholesky> cholesky_; ///< kept within a call, because the pattern is constant
    std::vector<Vec3> numbers_;          ///< [3 vertices] scratch; one component of each is used
    double decrement_ = 0.0;
};

} // namespace toile
