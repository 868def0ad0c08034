#pragma once

#include <array>
#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Term of a frozen Hessian: a spring against the motion of one weighted point,
///
///   1/2 u^T A u,   u = sum_k weight_k p_k
struct FrozenTerm {
    std::array<int, 4> vertex{-1, -1, -1, -1};    ///< -1: unused, at the end
    std::array<double, 4> weight{0., 0., 0., 0.}; ///< [-] of any sign; 0: unused
    Mat3 stiffness = Mat3::Zero();                ///< A [N/m] symmetric positive semi-definite
};

/// dH, the last frozen Hessian of an active set: a sum of FrozenTerms.
class FrozenHessian {
public:
    virtual ~FrozenHessian() = default;

    /// out += dH p. Same bits for every thread count.
    virtual void add_hessian_product(View<const Vec3> p, View<Vec3> out) const = 0;

    /// 3x3 bounds on dH per vertex: dH <= blockdiag(blocks), zero if nothing is active. [vertices]
    virtual View<const Mat3> diagonal_blocks() const = 0;

    /// Appends the terms, in the same order for every thread count.
    virtual void append_terms(std::vector<FrozenTerm>& terms) const = 0;

    /// True if those terms are all of dH; false if they only approximate it.
    virtual bool has_all_terms() const { return true; }
};

} // namespace toile
