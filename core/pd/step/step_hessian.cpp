#include "core/pd/step/step_hessian.h"

#include "core/compute/parallel.h"

namespace toile {

StepHessian::StepHessian(Curvature& curvature, View<const double> inertia, View<const unsigned char> fixed)
    : curvature_(curvature), fixed_(fixed), inertia_(inertia), diagonal_(inertia.size()),
      free_(inertia.size())
{
}

void StepHessian::linearise(View<const Vec3> x, Definiteness definiteness)
{
    curvature_.assemble(x, definiteness);
    update_active_set();
}

void StepHessian::update_active_set()
{
    const SparseMatrix& isotropic = curvature_.isotropic();
    parallel_for(kCpu, "pd/hessian_diagonal", int(diagonal_.size()), [&](int i) {
        if (fixed_[i]) {
            diagonal_[i].setIdentity();
            return;
        }
        diagonal_[i] = curvature_.blocks().diagonal(i);
        diagonal_[i].diagonal().array() += inertia_[i] + isotropic.coeff(i, i);
        if (active_)
            diagonal_[i] += active_->diagonal_blocks()[i];
    });
}

void StepHessian::multiply(View<const Vec3> p, View<Vec3> out)
{
    multiply_without_active_set(p, out);
    if (!active_)
        return;
    active_->add_hessian_product(free_, out);
    for (int i = 0; i < p.size(); ++i)
        if (fixed_[i])
            out[i] = p[i];
}

void StepHessian::multiply_without_active_set(View<const Vec3> p, View<Vec3> out)
{
    const SparseMatrix& isotropic = curvature_.isotropic();
    parallel_for(
        kCpu, "pd/hessian_input", p.size(), [&](int i) { free_[i] = fixed_[i] ? Vec3(Vec3::Zero()) : p[i]; },
        4096);
    parallel_for(kCpu, "pd/hessian_multiply", p.size(), [&](int i) {
        out[i] =
            inertia_[i] * p[i] + row_times(isotropic, i, free_) + curvature_.blocks().row_times(i, free_);
    });
    for (int i = 0; i < p.size(); ++i)
        if (fixed_[i])
            out[i] = p[i];
}

HessianParts StepHessian::parts() const
{
    HessianParts parts{fixed_, inertia_, curvature_.isotropic(), curvature_.blocks(), diagonal_, {}, nullptr};
    if (active_) {
        active_->append_terms(parts.terms);
        parts.whole_set = active_->has_all_terms() ? nullptr : active_;
    }
    return parts;
}

SparseMatrix StepHessian::matrix() const
{
    const int n = int(diagonal_.size());
    const BlockMatrix& blocks = curvature_.blocks();
    Triplets entries;
    for (int i = 0; i < n; ++i) {
        const double diagonal = fixed_[i] ? 1.0 : inertia_[i];
        for (int a = 0; a < 3; ++a)
            entries.emplace_back(3 * i + a, 3 * i + a, diagonal);
        // Entries of fixed vertices stay in the pattern as zeros.
        for (SparseMatrix::InnerIterator entry(curvature_.isotropic(), i); entry; ++entry) {
            const int j = int(entry.col());
            const double value = fixed_[i] || fixed_[j] ? 0.0 : entry.value();
            for (int a = 0; a < 3; ++a)
                entries.emplace_back(3 * i + a, 3 * j + a, value);
        }
        for (int k = 0; k < blocks.columns(i).size(); ++k) {
            const int j = blocks.columns(i)[k];
            const double factor = fixed_[i] || fixed_[j] ? 0.0 : 1.0;
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                    entries.emplace_back(3 * i + a, 3 * j + b, factor * blocks.blocks(i)[k](a, b));
        }
    }
    SparseMatrix K(3 * n, 3 * n);
    K.setFromTriplets(entries.begin(), entries.end());
    return K;
}

} // namespace toile
