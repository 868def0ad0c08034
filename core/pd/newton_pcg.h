#pragma once

#include <limits>
#include <vector>

#include "core/linear/pcg.h"
#include "core/pd/outer_loop.h"

namespace toile {

/// Newton's method with inexact steps [Nocedal & Wright 2006, alg. 7.1]: K d = -g is solved by conjugate
/// gradients as tightly as the gradient falls [Eisenstat & Walker 1996, choice 2], with the true Hessian K
/// and
///
///   P = H^-1 + blockdiag(K)^-1
///
/// H^-1 carries what is stiff through the whole cloth at once, the blocks know how soft it is across its
/// plane. K is the exact Hessian: it converges quadratically where projected ones stall. Where CG meets
/// negative curvature it stops at the direction found so far, which descends (P's own in the first
/// iteration).
///
/// An iteration costs one assembly of K and, for each of CG's, one product with K and one H^-1. Objectives
/// without second derivatives are refused.
class NewtonPcg : public OuterLoop {
public:
    /// CG iterations a step: a Newton step cut here costs as much as 20 of L-BFGS's.
    static constexpr int kMaxLinearIterations = 20;

    /// @param max_linear_iterations  at which CG is cut; hundreds for references that must have converged
    /// @param definiteness  Projected: slower, but CG is never stopped by negative curvature
    explicit NewtonPcg(int max_linear_iterations = kMaxLinearIterations,
                       Definiteness definiteness = Definiteness::Exact)
        : max_linear_iterations_(max_linear_iterations), definiteness_(definiteness)
    {
    }

    /// g . K^-1 g of the last step that CG solved accurately, twice the decrease that Newton's method still
    /// expected there [J]. Infinite where it has solved none.
    double decrement() const { return decrement_; }

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
    int linear_iterations() const override { return linear_iterations_; }

private:
    double forcing_term(View<const Vec3> gradient);
    void invert(View<const Mat3> blocks);

    int max_linear_iterations_;
    Definiteness definiteness_;
    Pcg pcg_;
    std::vector<Mat3> inverse_blocks_; ///< [vertices]
    int linear_iterations_ = 0;
    double previous_norm_ = 0.0;    ///< [N] of the gradient; 0 before the first iteration
    double previous_forcing_ = 0.0; ///< [-]
    double decrement_ = std::numeric_limits<double>::infinity();
};

} // namespace toile
