#pragma once

/// Eight numbers computed side by side. One templated kernel body serves a single item (T = double or float,
/// as on a GPU) and eight items in vector registers (T = Lanes, on the CPU).

#include <algorithm>
#include <cmath>

#include "core/compute/types.h"

#ifndef __CUDACC__
#include <experimental/simd>
#endif

namespace toile {

template <typename T>
using Vec3Of = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Mat2Of = Eigen::Matrix<T, 2, 2>;
template <typename T>
using Mat32Of = Eigen::Matrix<T, 3, 2>;
template <typename T>
using Mat3Of = Eigen::Matrix<T, 3, 3>;

/// condition ? yes : no
TOILE_HD inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
TOILE_HD inline float select(bool condition, float yes, float no) { return condition ? yes : no; }
TOILE_HD inline double square_root(double x) { return std::sqrt(x); }
TOILE_HD inline float square_root(float x) { return std::sqrt(x); }

/// Counterpart of FloatLanes in a thread of a GPU: as many numbers as it loads at once.
template <int Count>
struct alignas(Count * sizeof(float)) Floats {
    float value[Count];

    Floats() = default;
    TOILE_HD explicit Floats(float all)
    {
        for (float& number : value)
            number = all;
    }
    template <typename... Rest>
    TOILE_HD Floats(float first, float second, Rest... rest) : value{first, second, rest...}
    {
        static_assert(sizeof...(Rest) + 2 == Count);
    }
    TOILE_HD float operator[](int k) const { return value[k]; }
    TOILE_HD Floats& operator+=(const Floats& other)
    {
        for (int k = 0; k < Count; ++k)
            value[k] += other.value[k];
        return *this;
    }
    friend TOILE_HD Floats operator*(Floats a, float factor)
    {
        for (float& number : a.value)
            number *= factor;
        return a;
    }
    friend TOILE_HD Floats operator*(float factor, const Floats& a) { return a * factor; }
};

/// Vector padded to 16 bytes: one load on a GPU.
using PaddedVec3 = Floats<4>;

TOILE_HD inline PaddedVec3 padded(const Vec3& v)
{
    PaddedVec3 result(0.0F);
    for (int a = 0; a < 3; ++a)
        result.value[a] = float(v[a]);
    return result;
}
TOILE_HD inline Vec3 unpadded(const PaddedVec3& v) { return Vec3(double(v[0]), double(v[1]), double(v[2])); }

/// Dot product in single precision, returned as double for sums.
TOILE_HD inline double dot(const PaddedVec3& a, const PaddedVec3& b)
{
    return double(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/// Loads numbers from memory that is aligned as T.
template <typename T>
TOILE_HD T load_as(const float* numbers)
{
    return *reinterpret_cast<const T*>(numbers);
}

#ifndef __CUDACC__

inline constexpr int kLanes = 8;
using Lanes = std::experimental::fixed_size_simd<double, kLanes>;

/// Eight numbers in single precision, for tables that are read rather than computed with.
using FloatLanes = std::experimental::fixed_size_simd<float, kLanes>;
inline FloatLanes load(const float* numbers)
{
    return FloatLanes(numbers, std::experimental::element_aligned);
}
template <>
inline FloatLanes load_as<FloatLanes>(const float* numbers)
{
    return load(numbers);
}

/// condition ? yes : no, lane by lane
inline Lanes select(const Lanes::mask_type& condition, const Lanes& yes, const Lanes& no)
{
    Lanes result = no;
    std::experimental::where(condition, result) = yes;
    return result;
}
inline Lanes square_root(const Lanes& x) { return std::experimental::sqrt(x); }

/// Values of eight items: lane k holds value(min(first + k, count - 1)), so the last block repeats the last
/// item.
template <typename Value>
Lanes gather(int first, int count, const Value& value)
{
    return Lanes([&](auto lane) { return double(value(std::min(first + int(lane), count - 1))); });
}

/// Number of blocks of kLanes items that hold `count` items.
inline int lane_blocks(int count) { return (count + kLanes - 1) / kLanes; }

#endif

} // namespace toile

#ifndef __CUDACC__

template <>
struct Eigen::NumTraits<toile::Lanes> : Eigen::NumTraits<double> {
    using Real = toile::Lanes;
    using NonInteger = toile::Lanes;
    using Nested = toile::Lanes;
    using Literal = toile::Lanes;
};

#endif
