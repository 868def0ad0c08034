#pragma once

#include <vector>

#include "core/pd/outer_loop.h"

namespace toile {

/// Limited-memory BFGS with an inner approximate inverse Hessian [Nocedal & Wright 2006, alg. 7.4]. With
/// Projective Dynamics' H^-1 inside it is the quasi-Newton method of [Liu et al. 2017]: a few times fewer
/// iterations than plain local/global, at one application of H^-1 each.
///
/// The textbook two-loop recursion is used on purpose: unlike its Gram form it stays valid when the inner
/// operator changes between iterations, as it does when contacts open and close.
class Lbfgs : public OuterLoop {
public:
    /// Pairs whose curvature s.y is below this share of |s||y| carry rounding, not curvature [-].
    static constexpr double kMinCurvature = 1e-10;

    /// @param history  pairs kept; more than 5 bought nothing in docs/core/pd.md's measurements. At least 1.
    explicit Lbfgs(int history = 5);

protected:
    void begin(int vertex_count) override;
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
    void learn(const Step& step) override;
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
