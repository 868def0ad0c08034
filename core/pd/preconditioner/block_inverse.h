#pragma once

#include <vector>

#include "core/pd/preconditioner/contact_inverse.h"

namespace toile {

/// E = (D + blocks)^-1 with the 3x3 blocks that bound dH per vertex: closed form, exact if every term has one
/// vertex. If terms couple vertices it is too soft, by about the number of terms per vertex.
class BlockInverse : public ContactInverse {
public:
    void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) override;
    void apply(View<const Vec3> r, View<Vec3> z) const override;

    /// Takes any blocks [vertices] [N/m], symmetric positive semi-definite.
    void update(View<const Mat3> blocks, View<const double> D);

private:
    std::vector<Mat3> E_; ///< [vertices] [m/N]
};

} // namespace toile
