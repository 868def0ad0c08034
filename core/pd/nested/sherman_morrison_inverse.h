#pragma once

#include "core/pd/nested/block_inverse.h"

namespace toile {

/// Contact by contact [Sherman & Morrison 1950; Woodbury 1950]: with s = sum_k b_k^2 / D_k, a term alone has
///
///   (E r)_k = r_k / D_k - b_k / D_k G sum_j b_j r_j / D_j,   G = (I + s A)^-1 A
///
/// Exact where terms are disjoint. Terms that share a vertex with another one, and their vertices, are left
/// to the bound of BlockInverse.
class ShermanMorrisonInverse : public ContactInverse {
public:
    void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) override;
    void apply(View<const Vec3> r, View<Vec3> z) const override;

private:
    BlockInverse shared_;
    View<const double> D_;
    std::vector<FrozenTerm> disjoint_; ///< G in place of A [m/N]^-1
};

} // namespace toile
