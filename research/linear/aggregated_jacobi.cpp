#include "research/linear/aggregated_jacobi.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear/field.h"

namespace toile::research {

namespace {

/// R = I - damping D^-1 A; empty rows where vertices are fixed.
SparseMatrix iteration_matrix(const SparseMatrix& A, View<const double> inverse_diagonal, double damping)
{
    Triplets entries;
    for (int row = 0; row < int(A.rows()); ++row) {
        if (inverse_diagonal[row] == 0.0)
            continue;
        entries.emplace_back(row, row, 1.0);
        for (SparseMatrix::InnerIterator entry(A, row); entry; ++entry)
            entries.emplace_back(row, int(entry.col()), -damping * inverse_diagonal[row] * entry.value());
    }
    SparseMatrix R(A.rows(), A.cols());
    R.setFromTriplets(entries.begin(), entries.end());
    return R;
}

/// Bounds of I - R^l from those of w D^-1 H = I - R. 1 - r^l is monotonic in r for odd l; for even l it is
/// largest at r = 0.
SpectralBounds aggregated(const SpectralBounds& bounds, double damping, int order)
{
    const double top = 1.0 - std::pow(1.0 - damping * bounds.highest, order);
    const double bottom = 1.0 - std::pow(1.0 - damping * bounds.lowest, order);
    const bool has_zero = order % 2 == 0 && damping * bounds.highest >= 1.0;
    return {std::min(top, bottom), has_zero ? 1.0 : std::max(top, bottom)};
}

} // namespace

AggregatedSweeps::AggregatedSweeps(const SparseMatrix& A, View<const double> inverse_diagonal,
                                   const Settings& settings)
{
    const SpectralBounds of_jacobi = estimate_bounds(A, inverse_diagonal, settings.lanczos_steps);
    const double damping = 2.0 / (of_jacobi.lowest + of_jacobi.highest);
    bounds = aggregated(of_jacobi, damping, settings.order);
    steps = settings.accelerate ? chebyshev_steps(bounds, settings.applications)
                                : std::vector<ChebyshevStep>(settings.applications, {0.0, 1.0});
    before.assign(settings.order, {0.0, damping});

    const SparseMatrix once = iteration_matrix(A, inverse_diagonal, damping);
    R = once;
    for (int k = 1; k < settings.order; ++k)
        R = SparseMatrix(R * once);
}

void AggregatedJacobi::prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal)
{
    aggregated_ = AggregatedSweeps(A, inverse_diagonal, settings_);
    for (std::vector<Vec4>* field : {&c_, &d_, &other_})
        field->resize(inverse_diagonal.size());
    sweeps_ = ChebyshevJacobi(A, std::move(inverse_diagonal), aggregated_.before);
}

void AggregatedJacobi::solve_free(View<const Vec4> b, View<Vec4> x) const
{
    const std::vector<ChebyshevStep>& steps = aggregated_.steps;
    // The first application, from zero, is c itself. It is written to the array from which the last one ends
    // in x.
    sweeps_.solve(b, c_);
    View<Vec4> from = x, to = other_;
    if (steps.size() % 2 == 0)
        std::swap(from, to);
    const View<Vec4> c = c_, d = d_;
    parallel_for(
        kCpu, "baselines/first_sweep", b.size(), [&](int i) { from[i] = d[i] = steps[0].gain * c[i]; },
        kFieldGrain);

    // d = momentum d + gain (R^l x + c - x), x += d.
    for (size_t k = 1; k < steps.size(); ++k) {
        parallel_for(kCpu, "baselines/aggregated_sweep", b.size(), [&](int i) {
            const Vec4 change = row_times(aggregated_.R, i, View<const Vec4>(from)) + c[i] - from[i];
            d[i] = steps[k].momentum * d[i] + steps[k].gain * change;
            to[i] = from[i] + d[i];
        });
        std::swap(from, to);
    }
}

} // namespace toile::research
