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

/// Byte k of four as a number, minus 128. A GPU puts it into the last digits of 2^23, for its conversions are
/// slow.
TOILE_HD inline float byte_minus_128(std::uint32_t four, int k)
{
#ifdef __CUDA_ARCH__
    constexpr unsigned kTwoTo23 = 0x4b000000U, kByteBelowIt = 0x7440U;
    return __uint_as_float(__byte_perm(four, kTwoTo23, kByteBelowIt + unsigned(k))) - (8388608.0F + 128.0F);
#else
    return float(int(four >> (8 * k) & 0xffU) - 128);
#endif
}

} // namespace toile
