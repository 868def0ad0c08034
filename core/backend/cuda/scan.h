#pragma once

/// Where things go in a list that many threads write: the same place in every run.

#include <string_view>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/device.h"

namespace toile {

/// Memory that the functions below and sort.h work in; kept so that later calls ask for none.
using DeviceScratch = DeviceArray<unsigned char>;

/// first[i] = counts[0] + ... + counts[i - 1], in the stream's turn. Counted and refused as parallel_for; an
/// empty list launches nothing.
/// @param first  [as many as counts] out
void exclusive_scan(const CudaSpace& space, std::string_view name, View<const int> counts, View<long> first,
                    DeviceScratch& scratch, CallSite where = CallSite::here());

/// The places i with flags[i] != 0, ascending, in the stream's turn. Counted and refused as parallel_for; an
/// empty list launches nothing and leaves `count` as it is.
/// @param places  [as many as flags] out: the first count[0] of them
/// @param count   [1] out
void list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                  View<int> places, View<int> count, DeviceScratch& scratch,
                  CallSite where = CallSite::here());

/// The same, waited for: returns how many there are.
/// @param places  grows where it is shorter than flags
/// @param count   [1] scratch
int list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                 DeviceArray<int>& places, PinnedArray<int>& count, DeviceScratch& scratch,
                 CallSite where = CallSite::here());

} // namespace toile
