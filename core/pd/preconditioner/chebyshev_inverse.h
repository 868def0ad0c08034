#pragma once

#include "core/pd/preconditioner/block_inverse.h"
#include "core/pd/preconditioner/chebyshev.h"
#include "core/pd/preconditioner/coupled_part.h"

namespace toile {

/// Chebyshev steps on D + dH of the coupled vertices, preconditioned by its bound B = D + blocks
/// [Golub & Varga 1961]; 3x3 blocks for the others.
///
/// dH <= blocks puts the spectrum of B^-1 (D + dH) between min D/(D + |blocks|) and 1, so no estimate is
/// needed. The number of steps is chosen once per active set: the polynomial is fixed and E is linear.
class ChebyshevInverse : public ContactInverse {
public:
    /// Worst-case error after the steps [-], and the maximum number of steps.
    static constexpr double kContraction = 0.1;
    static constexpr int kMaxSteps = 32;

    void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) override;
    void apply(View<const Vec3> r, View<Vec3> z) const override;

    int step_count() const { return int(steps_.size()); }

private:
    BlockInverse uncoupled_;
    CoupledPart coupled_;
    std::vector<ChebyshevStep> steps_;
    std::vector<Mat3> bound_; ///< [coupled] B^-1 [m/N]
    mutable std::vector<Vec3> r_, x_, d_, next_;
};

} // namespace toile
