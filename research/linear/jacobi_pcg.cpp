#include "research/linear/jacobi_pcg.h"

#include <algorithm>
#include <utility>

#include "core/linear/field.h"

namespace toile::research {

namespace {

/// Quotient a / b lane by lane; 0 if b is not positive: that lane has converged, or rounding has lost its
/// direction.
Vec4 ratio(const Vec4& a, const Vec4& b) { return (b.array() > 0.0).select(a.array() / b.array(), 0.0); }

} // namespace

void JacobiPcg::prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal)
{
    A_ = A;
    inverse_diagonal_ = std::move(inverse_diagonal);
    for (std::vector<Vec4>* field : {&r_, &p_, &product_})
        field->resize(inverse_diagonal_.size());
}

void JacobiPcg::solve_free(View<const Vec4> b, View<Vec4> x) const
{
    const int n = b.size();
    const View<Vec4> r = r_, p = p_, product = product_;
    const Vec4 zero = Vec4::Zero();

    // x = 0, r = b, r . D^-1 r.
    Vec4 rz = parallel_sum(kCpu, n, zero, [&](int i) -> Vec4 {
        x[i].setZero();
        p[i].setZero();
        r[i] = b[i];
        return inverse_diagonal_[i] * r[i].cwiseAbs2();
    });
    const Vec4 target = settings_.tolerance * settings_.tolerance * rz;
    Vec4 rz_previous = zero;
    for (iterations_ = 0; iterations_ < settings_.max_iterations; ++iterations_) {
        if ((rz.array() <= target.array()).all())
            break;

        // p = D^-1 r + beta p.
        const Vec4 beta = ratio(rz, rz_previous);
        parallel_for(
            kCpu, "baselines/direction", n,
            [&](int i) { p[i] = inverse_diagonal_[i] * r[i] + beta.cwiseProduct(p[i]); }, kFieldGrain);
        parallel_for(kCpu, "baselines/product", n,
                     [&](int i) { product[i] = row_times(A_, i, View<const Vec4>(p)); });

        // alpha = r . D^-1 r / p . A p; x += alpha p, r -= alpha A p.
        const Vec4 curvature =
            parallel_sum(kCpu, n, zero, [&](int i) -> Vec4 { return p[i].cwiseProduct(product[i]); });
        const Vec4 alpha = ratio(rz, curvature);
        rz_previous = rz;
        rz = parallel_sum(kCpu, n, zero, [&](int i) -> Vec4 {
            x[i] += alpha.cwiseProduct(p[i]);
            r[i] -= alpha.cwiseProduct(product[i]);
            return inverse_diagonal_[i] * r[i].cwiseAbs2();
        });
    }
}

} // namespace toile::research
