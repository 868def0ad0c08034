#pragma once

#include <bit>
#include <cstdint>

#include "core/backend/types.h"

namespace toile {

/// Number of the lowest bit that is set, 0 to 63. `bits` is not 0.
TOILE_HD inline int lowest_bit(std::uint64_t bits)
{
#ifdef __CUDA_ARCH__
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

} // namespace toile
