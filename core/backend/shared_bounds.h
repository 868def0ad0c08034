#pragma once

#include <cmath>

#include "core/backend/types.h"

#ifndef __CUDA_ARCH__
#include <atomic>
#endif

namespace toile {

/// Lowers and raises bounds that many threads lower and raise at the same time: what is left is the least and
/// the largest of all, whoever came first. No NaN. (A GPU compares whole numbers at once; those of floats are
/// in the same order where both are positive, in the opposite one where both are negative.)
TOILE_HD inline void lower_shared(float& bound, float value)
{
#ifdef __CUDA_ARCH__
    if (signbit(value))
        atomicMax(reinterpret_cast<unsigned*>(&bound), __float_as_uint(value));
    else
        atomicMin(reinterpret_cast<int*>(&bound), __float_as_int(value));
#else
    const std::atomic_ref<float> shared(bound);
    float now = shared.load();
    while (value < now && !shared.compare_exchange_weak(now, value)) {
    }
#endif
}

TOILE_HD inline void raise_shared(float& bound, float value)
{
#ifdef __CUDA_ARCH__
    if (signbit(value))
        atomicMin(reinterpret_cast<unsigned*>(&bound), __float_as_uint(value));
    else
        atomicMax(reinterpret_cast<int*>(&bound), __float_as_int(value));
#else
    const std::atomic_ref<float> shared(bound);
    float now = shared.load();
    while (value > now && !shared.compare_exchange_weak(now, value)) {
    }
#endif
}

} // namespace toile
