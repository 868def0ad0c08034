#pragma once

/// Launches on a GPU that go from the leaves to the root of a tree without pointers, level by level. Included
/// by .cu files, as parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/implicit_tree.h"

namespace toile {

/// Constants of an upward pass in a tree whose nodes have 2^kFanBits children.
struct UpwardPass {
    static constexpr int kFanBits = 2;
    static constexpr int kLevels = 4; ///< per launch: a block ends at one node
    static constexpr int kThreads = 128, kTopThreads = 512;

    TOILE_HD static int nodes(int lowest, int level) { return level_size(lowest, kFanBits * level); }
    /// Number of nodes that lie so many levels below a node.
    TOILE_HD static int nodes_below(int levels) { return 1 << kFanBits * levels; }
};

#ifdef __CUDACC__

/// Runs the kernel on levels [begin, end) of the nodes below node b of level `summit`, b this block.
template <typename Kernel>
__global__ void upward_pass(int lowest, int begin, int end, int summit, const Kernel kernel)
{
    grid_dependency_wait();
    for (int level = begin; level < end; ++level) {
        const int count = UpwardPass::nodes_below(summit - level);
        const int first = int(blockIdx.x) * count;
        const int last = min(first + count, UpwardPass::nodes(lowest, level));
        for (int c = first + int(threadIdx.x); c < last; c += int(blockDim.x))
            kernel(level, c);
        __syncthreads();
    }
}

#endif

/// Launches kernel(level, c) for every node c above the lowest level, children before parents. Node c has the
/// children 4c .. 4c + 3 of the level below. kernel(level, c) may read all of its children and write node c.
/// Counts and throws as parallel_for.
///
/// A block passes through UpwardPass::kLevels levels up to one node; then a single block goes on to the root.
/// @param lowest  nodes of level 0, which are computed already
template <typename Kernel>
void parallel_upward_pass(const CudaSpace& space, std::string_view name, int lowest,
                          [[maybe_unused]] const Kernel& kernel, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    int levels = 1;
    while (lowest > 0 && UpwardPass::nodes(lowest, levels - 1) > 1)
        ++levels;
    if (levels == 1)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    const int below = std::min(levels, UpwardPass::kLevels + 1);
    launch_kernel(space, upward_pass<Kernel>,
                  block_count(lowest, UpwardPass::nodes_below(UpwardPass::kLevels)), UpwardPass::kThreads, 0,
                  lowest, 1, below, UpwardPass::kLevels, kernel);
    if (levels > below)
        launch_kernel(space, upward_pass<Kernel>, 1, UpwardPass::kTopThreads, 0, lowest, below, levels,
                      levels - 1, kernel);
#endif
    launch.done();
}

} // namespace toile
