#include "core/pd/preconditioner/chebyshev_inverse.h"

#include <algorithm>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "core/compute/parallel.h"

namespace toile {

void ChebyshevInverse::update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed)
{
    coupled_ = CoupledPart(free_terms(dH, fixed), D);
    uncoupled_.update(coupled_.blocks, D);
    const int count = int(coupled_.vertices.size());
    for (std::vector<Vec3>* field : {&r_, &x_, &d_, &next_})
        field->resize(count);
    bound_.resize(count);

    const View<const Mat3> blocks = dH.diagonal_blocks();
    SpectralBounds bounds{1.0, 1.0};
    for (int i = 0; i < count; ++i) {
        const int v = coupled_.vertices[i];
        const double stiffest = blocks[v].selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
        bounds.lowest = std::min(bounds.lowest, D[v] / (D[v] + stiffest));
        bound_[i] = (D[v] * Mat3::Identity() + blocks[v]).inverse();
    }
    int steps = 1;
    while (steps < kMaxSteps && chebyshev_contraction(bounds, steps) > kContraction)
        ++steps;
    steps_ = chebyshev_steps(bounds, steps);
}

void ChebyshevInverse::apply(View<const Vec3> r, View<Vec3> z) const
{
    uncoupled_.apply(r, z);
    const int count = int(coupled_.vertices.size());
    parallel_for(kCpu, "pd/nested_chebyshev", count, [&](int i) {
        r_[i] = r[coupled_.vertices[i]];
        x_[i] = d_[i] = steps_[0].gain * (bound_[i] * r_[i]);
    });
    for (size_t k = 1; k < steps_.size(); ++k) {
        parallel_for(kCpu, "pd/nested_chebyshev", count, [&](int i) {
            const Vec3 left = r_[i] - coupled_.matrix.row_times(i, x_);
            d_[i] = steps_[k].momentum * d_[i] + steps_[k].gain * (bound_[i] * left);
            next_[i] = x_[i] + d_[i];
        });
        x_.swap(next_);
    }
    for (int i = 0; i < count; ++i)
        z[coupled_.vertices[i]] = x_[i];
}

} // namespace toile
