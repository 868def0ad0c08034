#pragma once

#include <vector>

#include "core/pd/energy/frozen_hessian.h"

namespace toile {

/// Contact operator P_c of the paper's nested preconditioner P_e[P_c^3(.)]: effect of inertia and pointwise
/// contact on positions, by local/global iterations        [multilevel quadrature for PD, eq. 27, 28 and 30]
///
///   q <- (D0 + W)^-1 (D0 q~ + sum_c w_c S_c^T p_c(q)),   p_c = S_c q less the motion that contact resists
///
/// with D0 = M/dt^2 and W = sum_c w_c S_c^T S_c diagonal. Implemented in its linear form, in which all
/// contacts are active: p_c = (I - b b^T/|b|^2 A_c/w_c) S_c q, which for A_c = w n n^T is the projection onto
/// n . b q = 0.
///
/// The paper applies a map of positions to residuals, which are forces. Conversion with D0 before and
/// after is the only reading with consistent units. With equal masses it differs by a factor that does not
/// affect CG.
///
/// For comparison only: the composition is unsymmetric and CG stagnates with it (docs/theory/nested_pcg.md).
class PaperProjection {
public:
    static constexpr int kIterations = 3; ///< k_c of the paper

    /// @param inertia  [vertices] D0 [N/m], positive; borrowed
    void update(const FrozenHessian& dH, View<const double> inertia, View<const unsigned char> fixed);

    /// Computes z = D0 P_c^3(D0^-1 r). @param r, z  [vertices], different arrays
    void apply(View<const Vec3> r, View<Vec3> z) const;

private:
    View<const double> inertia_;
    std::vector<FrozenTerm> terms_; ///< A_c / |b|^2 in place of A_c
    std::vector<double> W_;         ///< [vertices] [N/m]
    mutable std::vector<Vec3> q_;   ///< [vertices] [m]
};

} // namespace toile
