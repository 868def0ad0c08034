#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "core/backend/cuda/scan.h"

namespace toile {

/// Keys and what belongs to them, twice: a sort reads one and writes the other.
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

/// Bits by which the keys 0 .. count - 1 and the one of all ones differ.
inline int key_bits(long count) { return int(std::bit_width(std::uint64_t(count))); }

/// sorted = values by their keys, ascending, those of equal keys as they were; in the stream's turn. Counted
/// and refused as parallel_for; an empty list launches nothing.
/// @param sorted  [as many as arrays.values] out
/// @param bits    the lowest of the keys, which alone count: the fewer, the faster
void sort_by_key(const CudaSpace& space, std::string_view name, SortArrays& arrays, View<int> sorted,
                 int bits = 64, CallSite where = CallSite::here());

} // namespace toile
