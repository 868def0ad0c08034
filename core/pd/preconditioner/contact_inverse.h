#pragma once

#include "core/pd/energy/frozen_hessian.h"

namespace toile {

/// E = (D + dH)^-1 or an approximation, with D = diag(H): response of contact alone, if the cloth around it
/// is reduced to its diagonal. Linear, symmetric and positive definite at any accuracy, so that NestedPcg may
/// use it inside conjugate gradients.
///
/// Fixed vertices are excluded: dH is that of the free ones, and E is 1/D at fixed ones.
class ContactInverse {
public:
    virtual ~ContactInverse() = default;

    /// @param D      [vertices] [N/m], positive; borrowed until the next update
    /// @param fixed  [vertices] 1 if the position is prescribed
    virtual void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) = 0;

    /// Computes z = E r. Same bits for every thread count. @param r, z  [vertices], different arrays
    virtual void apply(View<const Vec3> r, View<Vec3> z) const = 0;
};

} // namespace toile
