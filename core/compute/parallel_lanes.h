#pragma once

#include "core/compute/lanes.h"
#include "core/compute/parallel.h"

namespace toile {

/// Runs kernel(block) for the blocks of `count` items, kLanes each, that a kernel computes side by side; see
/// parallel_for().
///
/// Everything in the kernel is inlined. By itself a compiler leaves the operators of Lanes as functions in
/// kernels that have thousands of them, which then take up to 12 times as long.
template <typename Kernel>
void parallel_for_lanes(CpuSpace, std::string_view name, int count, const Kernel& kernel)
{
    parallel_for(
        kCpu, name, lane_blocks(count), [&](int block) __attribute__((flatten)) { kernel(block); },
        kGrain / kLanes);
}

} // namespace toile
