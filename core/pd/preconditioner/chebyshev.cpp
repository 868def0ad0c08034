#include "core/pd/preconditioner/chebyshev.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"

namespace toile {

std::vector<ChebyshevStep> chebyshev_steps(const SpectralBounds& bounds, int count)
{
    const double center = 0.5 * (bounds.highest + bounds.lowest);
    const double radius = 0.5 * (bounds.highest - bounds.lowest);
    std::vector<ChebyshevStep> steps;
    steps.push_back({0.0, 1.0 / center});
    double rho = radius / center;
    while (int(steps.size()) < count) {
        // 2 rho / radius stays finite if the interval is a point: rho is proportional to the radius.
        const double next = 1.0 / (2.0 * center - radius * rho); // rho_next / radius
        steps.push_back({radius * next * rho, 2.0 * next});
        rho = radius * next;
    }
    return steps;
}

double chebyshev_contraction(const SpectralBounds& bounds, int count)
{
    if (!(bounds.highest > bounds.lowest))
        return 0.0;
    const double sigma = (bounds.highest + bounds.lowest) / (bounds.highest - bounds.lowest);
    return 1.0 / std::cosh(count * std::acosh(sigma));
}

ChebyshevJacobi::ChebyshevJacobi(const SparseMatrix& A, std::vector<double> inverse_diagonal,
                                 std::vector<ChebyshevStep> steps)
    : A_(A), inverse_diagonal_(std::move(inverse_diagonal)), steps_(std::move(steps)),
      d_(inverse_diagonal_.size()), other_(inverse_diagonal_.size())
{
    TOILE_ASSERT(!steps_.empty());
}

void ChebyshevJacobi::sweep(const ChebyshevStep& step, View<const Vec4> b, View<const Vec4> x,
                            View<Vec4> next) const
{
    const View<Vec4> d = d_;
    parallel_for(kCpu, "baselines/sweep", b.size(), [&](int i) {
        const Vec4 r = b[i] - row_times(A_, i, x);
        d[i] = step.momentum * d[i] + (step.gain * inverse_diagonal_[i]) * r;
        next[i] = x[i] + d[i];
    });
}

void ChebyshevJacobi::solve(View<const Vec4> b, View<Vec4> x) const
{
    // The first step needs no product. Choose its output so that the last one ends in x.
    View<Vec4> from = x, to = other_;
    if (steps_.size() % 2 == 0)
        std::swap(from, to);
    const View<Vec4> d = d_;
    parallel_for(
        kCpu, "baselines/first_sweep", b.size(),
        [&](int i) { from[i] = d[i] = (steps_[0].gain * inverse_diagonal_[i]) * b[i]; }, kFieldGrain);
    for (size_t k = 1; k < steps_.size(); ++k) {
        sweep(steps_[k], b, from, to);
        std::swap(from, to);
    }
}

void ChebyshevJacobi::improve(View<const Vec4> b, View<Vec4> x) const
{
    View<Vec4> from = x, to = other_;
    if (steps_.size() % 2 == 1) { // an odd number of steps would end in the other array
        std::swap(from, to);
        std::copy(x.begin(), x.end(), from.begin());
    }
    for (const ChebyshevStep& step : steps_) {
        sweep(step, b, from, to); // the first has no momentum, so the content of d does not matter
        std::swap(from, to);
    }
}

void ChebyshevJacobi::residual(View<const Vec4> b, View<const Vec4> x, View<Vec4> r) const
{
    parallel_for(kCpu, "baselines/residual", b.size(), [&](int i) { r[i] = b[i] - row_times(A_, i, x); });
}

} // namespace toile
