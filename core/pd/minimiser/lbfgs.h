#pragma once

#include <vector>

#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Limited-memory BFGS with an inner approximate inverse Hessian [Nocedal & Wright 2006, alg. 7.4]. With
/// Projective Dynamics' H^-1 inside it is the quasi-Newton method of [Liu et al. 2017]. It takes a few times
/// fewer iterations than plain local/global, with one application of H^-1 each.
///
/// Uses the textbook two-loop recursion. Unlike its Gram form it stays valid when the inner operator changes
/// between iterations, as it does when contacts open and close.
class Lbfgs : public OuterLoop {
public:
    /// Curvature s.y relative to |s||y| below which a pair holds rounding error, not curvature [-].
    static constexpr double kMinCurvature = 1e-10;

    /// @param history  stored pairs; more than 5 gained nothing in the measurements of
    ///                 docs/journal/projective_dynamics.md. At least 1.
    explicit Lbfgs(int history = 5);

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
    void update_history(const Step& step) override;
    bool fall_back() override;

private:
    struct Pair {
        std::vector<Vec3> s, y; ///< change of x [m] and of the gradient [N]
        double rho = 0.0;       ///< 1 / (s . y)
    };

    int history_;
    std::vector<Pair> pairs_; ///< oldest first
    std::vector<Pair> spare_; ///< memory of dropped pairs, reused
    std::vector<double> alpha_;
};

} // namespace toile
