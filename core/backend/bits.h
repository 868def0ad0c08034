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

/// Byte k of four as 1 + kByteUnit byte: a GPU puts it among the digits of a 1, for its conversions are slow.
inline constexpr float kByteUnit = 1.0F / 32768.0F;
TOILE_HD inline float one_and_byte(std::uint32_t four, int k)
{
#ifdef __CUDA_ARCH__
    constexpr unsigned kOne = 0x3f800000U, kByteInDigits = 0x7604U;
    return __uint_as_float(__byte_perm(four, kOne, kByteInDigits + (unsigned(k) << 4)));
#else
    return 1.0F + kByteUnit * float(four >> (8 * k) & 0xffU);
#endif
}

} // namespace toile
