#pragma once

#include <limits>
#include <vector>

#include "core/linear/pcg.h"
#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Newton's method with inexact steps [Nocedal & Wright 2006, alg. 7.1]. Conjugate gradients solve
/// K d = -g to a tolerance that follows the decrease of the gradient [Eisenstat & Walker 1996, choice 2]. K
/// is the true Hessian, and the preconditioner is
///
///   P = H^-1 + blockdiag(K)^-1
///
/// H^-1 propagates stiff modes through the whole cloth at once; the blocks represent its softness across its
/// plane. With the exact Hessian K the method converges quadratically where projected ones stall. At negative
/// curvature CG stops with the direction found so far, which descends (P's own in the first iteration).
///
/// An iteration costs one assembly of K and, for each iteration of CG, one product with K and one H^-1.
/// Throws if the objective has no second derivatives.
class NewtonPcg : public OuterLoop {
public:
    /// CG iterations per step: a Newton step cut here costs as much as 20 of L-BFGS.
    static constexpr int kMaxLinearIterations = 20;

    /// @param max_linear_iterations  limit of CG; hundreds for converged reference solutions
    /// @param definiteness  Projected: slower, but negative curvature never stops CG
    explicit NewtonPcg(int max_linear_iterations = kMaxLinearIterations,
                       Definiteness definiteness = Definiteness::Exact)
        : max_linear_iterations_(max_linear_iterations), definiteness_(definiteness)
    {
    }

    /// g . K^-1 g of the last step that CG solved accurately, twice the decrease that Newton's method
    /// expected there [J]. Infinite if there is none.
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
