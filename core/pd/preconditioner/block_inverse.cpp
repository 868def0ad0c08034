#include "core/pd/preconditioner/block_inverse.h"

#include <Eigen/LU>

#include "core/compute/parallel.h"

namespace toile {

void BlockInverse::update(const FrozenHessian& dH, View<const double> D, View<const unsigned char>)
{
    update(dH.diagonal_blocks(), D);
}

void BlockInverse::update(View<const Mat3> blocks, View<const double> D)
{
    E_.resize(D.size());
    parallel_for(kCpu, "pd/contact_blocks", D.size(), [&](int i) {
        if (blocks[i].isZero(0.0))
            E_[i] = Mat3::Identity() / D[i];
        else
            E_[i] = (blocks[i] + D[i] * Mat3::Identity()).inverse();
    });
}

void BlockInverse::apply(View<const Vec3> r, View<Vec3> z) const
{
    parallel_for(kCpu, "pd/nested_blocks", r.size(), [&](int i) { z[i] = E_[i] * r[i]; });
}

} // namespace toile
