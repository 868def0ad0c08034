#pragma once

#include <cmath>
#include <vector>

#include "core/linear/field.h"
#include "core/linear/global_solver.h"

namespace toile::test {

/// Asymptotic factor per step of x -> x - A H x: the spectral radius of I - A H by power iteration, as the
/// geometric mean of the last ten steps.
/// @param x      [n] start, 0 at fixed vertices
/// @param steps  more than ten
inline double contraction(const GlobalSolver& solver, const SparseMatrix& H, std::vector<Vec3> x, int steps)
{
    constexpr int kMeasured = 10;
    const int n = int(x.size());
    std::vector<Vec3> product(n), correction(n);
    double log_ratio = 0.0;
    for (int step = 0; step < steps; ++step) {
        const double before = std::sqrt(dot(x, x));
        for (int i = 0; i < n; ++i)
            product[i] = row_times(H, i, x);
        solver.solve(product, correction);
        axpy(-1.0, correction, x);
        const double after = std::sqrt(dot(x, x));
        if (step >= steps - kMeasured)
            log_ratio += std::log(after / before) / kMeasured;
        for (Vec3& v : x)
            v /= after;
    }
    return std::exp(log_ratio);
}

} // namespace toile::test
