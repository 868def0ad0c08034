#pragma once

#include "core/backend/cuda/array.h"

namespace toile {

/// Enqueues sums[i] = numbers[0] + ... + numbers[i - 1]: where item i of lists that are written one after the
/// other begins. Exact, so the same in every run.
/// @param name     a literal
/// @param numbers  [n]; not the array of the sums
/// @param scratch  grows to what CUB asks for, some bytes per thousand numbers
/// @throws DeviceError when the launch is refused
void exclusive_sums(const CudaSpace& space, std::string_view name, View<const int> numbers, View<int> sums,
                    DeviceArray<unsigned char>& scratch, CallSite where = CallSite::here());

} // namespace toile
