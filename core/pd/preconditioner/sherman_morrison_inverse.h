#pragma once

#include "core/pd/preconditioner/block_inverse.h"

namespace toile {

/// Inverse per contact [Sherman & Morrison 1950; Woodbury 1950]: with s = sum_k b_k^2 / D_k, a single term
/// has
///
///   (E r)_k = r_k / D_k - b_k / D_k G sum_j b_j r_j / D_j,   G = (I + s A)^-1 A
///
/// Exact for disjoint terms. Terms that share a vertex with another one, and their vertices, use the bound of
/// BlockInverse.
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
