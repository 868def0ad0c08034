#pragma once

#include <bit>
#include <cstdint>

#include "core/compute/types.h"

namespace toile::preview {

/// Scrambles the bits of an index, lower bits deciding about higher ones.    [Burley 2020, listing 2]
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

inline std::uint32_t reverse_bits(std::uint32_t x)
{
    x = __builtin_bswap32(x);
    x = (x & 0x0f0f0f0fu) << 4 | (x & 0xf0f0f0f0u) >> 4;
    x = (x & 0x33333333u) << 2 | (x & 0xccccccccu) >> 2;
    return (x & 0x55555555u) << 1 | (x & 0xaaaaaaaau) >> 1;
}

inline std::uint32_t hash(std::uint32_t x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ x >> 16;
}

/// Low-discrepancy points of the unit square, different for each pixel and purpose, the same in every run:
/// Sobol points, shuffled and Owen-scrambled by hashes of the pixel. [Burley 2020, section 3]
class PixelSampler {
public:
    explicit PixelSampler(int pixel) : seed_(hash(std::uint32_t(pixel) + 0x9e3779b9u)) {}

    /// @param sample   0, 1, ...; any power of two of them is evenly distributed
    /// @param purpose  0, 1, ...; points of different purposes are independent
    Vec2 point(int sample, int purpose) const
    {
        const std::uint32_t seed = hash(seed_ ^ std::uint32_t(purpose) * 0x85ebca6bu);
        const std::uint32_t index = scramble(std::uint32_t(sample), seed);
        const std::uint32_t x =
            laine_karras(index, hash(seed + 1)); // Sobol's x and scramble() each reverse the bits
        return Vec2(unit(reverse_bits(x)), unit(scramble(sobol_y(index), hash(seed + 2))));
    }

private:
    static std::uint32_t scramble(std::uint32_t x, std::uint32_t seed)
    {
        return reverse_bits(laine_karras(reverse_bits(x), seed));
    }
    static std::uint32_t sobol_y(std::uint32_t index)
    {
        std::uint32_t y = 0;
        for (std::uint32_t v = 1u << 31; index != 0; index >>= 1, v ^= v >> 1)
            if (index & 1)
                y ^= v;
        return y;
    }
    static double unit(std::uint32_t x) { return x * 0x1p-32; }

    std::uint32_t seed_;
};

} // namespace toile::preview
