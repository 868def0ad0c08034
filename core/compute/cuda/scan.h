#pragma once

/// Offsets and order in lists that many threads write, the same in every run.

#include <string_view>

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/runtime/device.h"

namespace toile {

/// Temporary memory of the functions below and of sort.h; kept so that later calls allocate nothing.
using DeviceScratch = DeviceArray<unsigned char>;

/// first[i] = counts[0] + ... + counts[i - 1], in stream order. Counts and throws as parallel_for; an empty
/// list launches nothing.
/// @param first  [as many as counts] out
void exclusive_scan(const CudaSpace& space, std::string_view name, View<const int> counts, View<long> first,
                    DeviceScratch& scratch, CallSite where = CallSite::here());

/// Indices i with flags[i] != 0, ascending, in stream order. Counts and throws as parallel_for; an empty list
/// launches nothing and leaves `count` as it is.
/// @param indices  [as many as flags] out: the first count[0] of them
/// @param count    [1] out
void list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                  View<int> indices, View<int> count, DeviceScratch& scratch,
                  CallSite where = CallSite::here());

/// Lists likewise, waits and returns the number of indices.
/// @param indices  grows if it is shorter than flags
/// @param count    [1] scratch
int list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                 DeviceArray<int>& indices, PinnedArray<int>& count, DeviceScratch& scratch,
                 CallSite where = CallSite::here());

} // namespace toile
