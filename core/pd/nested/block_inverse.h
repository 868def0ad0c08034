#pragma once

#include <vector>

#include "core/pd/nested/contact_inverse.h"

namespace toile {

/// E = (D + blocks)^-1 with the 3x3 blocks that bound dH vertex by vertex: closed form, exact where every
/// term has one vertex. Where terms couple vertices it is too soft, by about as much as terms meet there.
class BlockInverse : public ContactInverse {
public:
    void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) override;
    void apply(View<const Vec3> r, View<Vec3> z) const override;

    /// The same with any blocks [vertices] [N/m], symmetric positive semi-definite.
    void update(View<const Mat3> blocks, View<const double> D);

private:
    std::vector<Mat3> E_; ///< [vertices] [m/N]
};

} // namespace toile
