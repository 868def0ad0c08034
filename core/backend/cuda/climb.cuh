#pragma once

/// Launches on a GPU that go up a tree without pointers, level by level. Included by .cu files, as
/// parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/implicit_tree.h"

namespace toile {

/// How a tree is climbed whose nodes have 2^kFanBits children.
struct Climb {
    static constexpr int kFanBits = 2;
    static constexpr int kLevels = 4; ///< that a block climbs, until one node is left of its own
    static constexpr int kThreads = 128, kTopThreads = 512;

    TOILE_HD static int nodes(int lowest, int level) { return level_size(lowest, kFanBits * level); }
    /// Nodes that are below one so many levels higher.
    TOILE_HD static int nodes_below(int levels) { return 1 << kFanBits * levels; }
};

#ifdef __CUDACC__

/// Levels [begin, end) of the nodes below node b of level `summit`, b this block.
template <typename Kernel>
__global__ void climb(int lowest, int begin, int end, int summit, const Kernel kernel)
{
    wait_for_turn();
    for (int level = begin; level < end; ++level) {
        const int count = Climb::nodes_below(summit - level);
        const int first = int(blockIdx.x) * count;
        const int last = min(first + count, Climb::nodes(lowest, level));
        for (int c = first + int(threadIdx.x); c < last; c += int(blockDim.x))
            kernel(level, c);
        __syncthreads();
    }
}

#endif

/// Launches kernel(level, c) for every node c of the levels above the lowest of a tree in which node c has
/// the children 4c .. 4c + 3 of the level below, children before parents: a block climbs Climb::kLevels
/// levels to one node, then a single block to the root. kernel(level, c) may read all of its children and
/// write its own node. Counted and refused as parallel_for.
/// @param lowest  nodes of level 0, which are there already
template <typename Kernel>
void parallel_climb(const CudaSpace& space, std::string_view name, int lowest,
                    [[maybe_unused]] const Kernel& kernel, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    int levels = 1;
    while (lowest > 0 && Climb::nodes(lowest, levels - 1) > 1)
        ++levels;
    if (levels == 1)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    const int below = std::min(levels, Climb::kLevels + 1);
    launch_kernel(space, climb<Kernel>, block_count(lowest, Climb::nodes_below(Climb::kLevels)),
                  Climb::kThreads, 0, lowest, 1, below, Climb::kLevels, kernel);
    if (levels > below)
        launch_kernel(space, climb<Kernel>, 1, Climb::kTopThreads, 0, lowest, below, levels, levels - 1,
                      kernel);
#endif
    launch.done();
}

} // namespace toile
