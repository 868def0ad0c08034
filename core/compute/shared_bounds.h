#pragma once

#include <cmath>
#include <type_traits>

#include "core/compute/types.h"

#ifndef __CUDA_ARCH__
#include <atomic>
#endif

namespace toile {

/// Bits of a float or double as an integer, which a GPU compares atomically. The order is the same if both
/// numbers are positive, and reversed if both are negative.
template <typename Real>
struct WholeNumbers {
    static_assert(std::is_same_v<Real, float> || std::is_same_v<Real, double>);
    using Signed = std::conditional_t<sizeof(Real) == sizeof(int), int, long long>;
    using Unsigned = std::make_unsigned_t<Signed>;

#ifdef __CUDACC__
    __device__ static Signed of(float value) { return __float_as_int(value); }
    __device__ static Signed of(double value) { return __double_as_longlong(value); }
#endif
};

// Bounds that many threads lower and raise at the same time. The result is the minimum or maximum of all
// values, in whatever order they come. No NaN.

template <typename Real>
TOILE_HD void lower_shared(Real& bound, Real value)
{
#ifdef __CUDA_ARCH__
    using Numbers = WholeNumbers<Real>;
    if (signbit(value))
        atomicMax(reinterpret_cast<typename Numbers::Unsigned*>(&bound),
                  typename Numbers::Unsigned(Numbers::of(value)));
    else
        atomicMin(reinterpret_cast<typename Numbers::Signed*>(&bound), Numbers::of(value));
#else
    const std::atomic_ref<Real> shared(bound);
    Real now = shared.load();
    while (value < now && !shared.compare_exchange_weak(now, value)) {
    }
#endif
}

template <typename Real>
TOILE_HD void raise_shared(Real& bound, Real value)
{
#ifdef __CUDA_ARCH__
    using Numbers = WholeNumbers<Real>;
    if (signbit(value))
        atomicMin(reinterpret_cast<typename Numbers::Unsigned*>(&bound),
                  typename Numbers::Unsigned(Numbers::of(value)));
    else
        atomicMax(reinterpret_cast<typename Numbers::Signed*>(&bound), Numbers::of(value));
#else
    const std::atomic_ref<Real> shared(bound);
    Real now = shared.load();
    while (value > now && !shared.compare_exchange_weak(now, value)) {
    }
#endif
}

} // namespace toile
