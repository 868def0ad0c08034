#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "core/compute/types.h"

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

/// Reads an integer or float of any size, little endian.
template <typename T>
T take(const char* bytes)
{
    static_assert(std::is_arithmetic_v<T>);
    char word[sizeof(T)];
    std::memcpy(word, bytes, sizeof word);
    if constexpr (std::endian::native != std::endian::little)
        std::reverse(word, word + sizeof word);
    return std::bit_cast<T>(word);
}

/// Reads as many of them as there are.
template <typename T>
std::vector<T> values_of(const std::string& bytes)
{
    std::vector<T> values;
    values.reserve(bytes.size() / sizeof(T));
    for (std::size_t k = 0; k + sizeof(T) <= bytes.size(); k += sizeof(T))
        values.push_back(take<T>(&bytes[k]));
    return values;
}

/// Appends an integer or float of any size to bytes, little endian.
template <typename T>
void append(std::string& bytes, T value)
{
    static_assert(std::is_arithmetic_v<T>);
    char word[sizeof value];
    std::memcpy(word, &value, sizeof value);
    if constexpr (std::endian::native != std::endian::little)
        std::reverse(word, word + sizeof value);
    bytes.append(word, sizeof word);
}

/// Bytes of numbers in single precision, little endian.
inline std::string bytes_of(View<const float> numbers)
{
    std::string bytes;
    bytes.reserve(sizeof(float) * size_t(numbers.size()));
    for (const float number : numbers)
        append(bytes, number);
    return bytes;
}
inline std::string bytes_of(View<const Vec3> vectors)
{
    std::string bytes;
    bytes.reserve(3 * sizeof(float) * size_t(vectors.size()));
    for (const Vec3& vector : vectors)
        for (int axis = 0; axis < 3; ++axis)
            append(bytes, float(vector[axis]));
    return bytes;
}

} // namespace toile::exports
