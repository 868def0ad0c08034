#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

namespace toile::exports {

/// Stores a 32-bit integer or float at `bytes` in the byte order of the file, on any machine.
template <std::endian kOrder, typename T>
void put(char* bytes, T value)
{
    static_assert(sizeof(T) == 4);
    auto word = std::bit_cast<std::uint32_t>(value);
    if constexpr (kOrder != std::endian::native)
        word = __builtin_bswap32(word);
    std::memcpy(bytes, &word, sizeof word);
}

/// Reads a value stored by put().
template <std::endian kOrder, typename T>
T get(const char* bytes)
{
    static_assert(sizeof(T) == 4);
    std::uint32_t word = 0;
    std::memcpy(&word, bytes, sizeof word);
    if constexpr (kOrder != std::endian::native)
        word = __builtin_bswap32(word);
    return std::bit_cast<T>(word);
}

} // namespace toile::exports
