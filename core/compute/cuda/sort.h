#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "core/compute/cuda/scan.h"

namespace toile {

/// Keys and values of a sort, with a second array of keys for its output.
struct SortArrays {
    explicit SortArrays(const CudaSpace& space)
        : keys(space, "sort/keys"), sorted_keys(space, "sort/sorted_keys"), values(space, "sort/values"),
          scratch(space, "sort/scratch")
    {
    }

    void resize(int count)
    {
        keys.resize(count);
        sorted_keys.resize(count);
        values.resize(count);
    }

    DeviceArray<std::uint64_t> keys, sorted_keys;
    DeviceArray<int> values;
    DeviceScratch scratch;
};

/// Number of low bits in which the keys 0 .. count - 1 and the key of all ones differ.
inline int key_bits(long count) { return int(std::bit_width(std::uint64_t(count))); }

/// sorted = values by ascending keys, in stream order; values of equal keys keep their order. Counts and
/// throws as parallel_for; an empty list launches nothing.
/// @param sorted  [as many as arrays.values] out
/// @param bits    number of low bits of the keys to sort by: the fewer, the faster
void sort_by_key(const CudaSpace& space, std::string_view name, SortArrays& arrays, View<int> sorted,
                 int bits = 64, CallSite where = CallSite::here());

} // namespace toile
