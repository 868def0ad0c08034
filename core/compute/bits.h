#pragma once

#include <bit>
#include <cstdint>

#include "core/compute/types.h"

namespace toile {

/// Index of the lowest set bit, 0 to 63. `bits` is not 0.
TOILE_HD inline int lowest_bit(std::uint64_t bits)
{
#ifdef __CUDA_ARCH__
    return __ffsll(static_cast<long long>(bits)) - 1;
#else
    return std::countr_zero(bits);
#endif
}

/// Unit of one_and_byte(), which returns byte k of `four` as 1 + kByteUnit byte. A GPU puts the byte into the
/// mantissa of 1, because its conversions are slow.
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
