#pragma once

#include <algorithm>
#include <cmath>

#include "core/compute/parallel.h"

namespace toile {

/// Linear algebra on fields of 3-vectors [vertices], with the same bits for every thread count.

/// Items per task. A vector update is so short that smaller tasks would cost more than they save.
inline constexpr int kFieldGrain = 4096;

/// a . b
inline double dot(View<const Vec3> a, View<const Vec3> b)
{
    return parallel_sum(kCpu, a.size(), 0.0, [&](int i) { return a[i].dot(b[i]); });
}

/// y += factor x
inline void axpy(double factor, View<const Vec3> x, View<Vec3> y)
{
    parallel_for(
        kCpu, "field/axpy", y.size(), [&](int i) { y[i] += factor * x[i]; }, kFieldGrain);
}

/// y += factor x, returns y . z. One pass over memory instead of two.
inline double axpy_dot(double factor, View<const Vec3> x, View<Vec3> y, View<const Vec3> z)
{
    return parallel_sum(kCpu, y.size(), 0.0, [&](int i) {
        y[i] += factor * x[i];
        return y[i].dot(z[i]);
    });
}

/// y = x + factor y
inline void xpay(View<const Vec3> x, double factor, View<Vec3> y)
{
    parallel_for(
        kCpu, "field/xpay", y.size(), [&](int i) { y[i] = x[i] + factor * y[i]; }, kFieldGrain);
}

/// Max length of the vectors; NaN if any entry is.
inline double max_norm(View<const Vec3> x)
{
    double largest = 0.0;
    for (const Vec3& value : x) {
        const double squared = value.squaredNorm();
        if (std::isnan(squared)) // no later comparison may lose it
            return squared;
        largest = std::max(largest, squared);
    }
    return std::sqrt(largest);
}

} // namespace toile
