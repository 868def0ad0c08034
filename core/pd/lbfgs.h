#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

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

/// Limited-memory BFGS with an inner approximate inverse Hessian and Armijo backtracking
/// [Nocedal & Wright 2006, alg. 7.4 and 3.1]. With Projective Dynamics' H^-1 inside it is the quasi-Newton
/// method of [Liu et al. 2017]: a few times fewer iterations than plain local/global, at one application of
/// H^-1 each.
///
/// The textbook two-loop recursion is used on purpose: unlike its Gram form it stays valid when the inner
/// operator changes between iterations, as it does when contacts open and close.
class Lbfgs {
public:
    struct Settings {
        double tolerance = 1e-5; ///< [m] stop when no vertex moves further in an iteration
        int max_iterations = 50;
        int history = 5; ///< pairs kept; more bought nothing in docs/core/pd.md's measurements
    };
    struct Outcome {
        int iterations = 0;
        bool converged = false;
        double displacement = 0.0;  ///< [m] largest move of the last iteration
        double gradient_norm = 0.0; ///< [N] largest entry of the gradient at the end
        double value = 0.0;         ///< [J]; not finite when the start already was not
    };

    /// Minimises from x, in place.
    Outcome minimise(Objective& objective, View<Vec3> x, const Settings& settings);

private:
    struct Pair {
        std::vector<Vec3> s, y; ///< change of x [m] and of the gradient [N]
        double rho = 0.0;       ///< 1 / (s . y)
    };

    void descend(Objective& objective);
    double line_search(Objective& objective, View<Vec3> x, double& value);
    void remember(double step);

    std::vector<Pair> pairs_; ///< oldest first
    std::vector<Pair> spare_; ///< memory of dropped pairs, reused
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
    std::vector<double> alpha_;
};

} // namespace toile
