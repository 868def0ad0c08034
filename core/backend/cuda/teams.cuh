#pragma once

/// Launches on a GPU in which threads work together: on one item, or level by level on a tree. Included by
/// .cu files, as parallel.cuh.

#include <string_view>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/implicit_tree.h"

namespace toile {

/// The threads that share an item: a warp.
struct Team {
    static constexpr int kThreads = 32;

    int thread; ///< [0, kThreads)

    /// Sum over the threads whose number leaves the same remainder by `stride`, a power of two; all of them
    /// get it. Pairs in a tree: the same bits in every run.
    TOILE_HD float sum([[maybe_unused]] int stride, float value) const
    {
#ifdef __CUDA_ARCH__
        for (int offset = kThreads / 2; offset >= stride; offset /= 2)
            value += __shfl_xor_sync(0xffffffffU, value, offset);
#endif
        return value;
    }
};

/// Nodes of the lowest level whose subtree one block climbs.
inline constexpr int kSubtreeNodes = 32;
inline constexpr int kSubtreeLevels = 5; ///< above the lowest, until one node is left of them
static_assert(kSubtreeNodes == 1 << kSubtreeLevels);

#ifdef __CUDACC__

template <typename Kernel>
__global__ void run_teams(int count, const Kernel kernel)
{
    const int item = int((long(blockIdx.x) * blockDim.x + threadIdx.x) / Team::kThreads);
    if (item < count)
        kernel(item, Team{int(threadIdx.x) % Team::kThreads});
}

/// Levels [begin, end) of the nodes above lowest nodes [b << shift, (b + 1) << shift), b this block of tree
/// blockIdx.y.
template <typename Kernel>
__global__ void climb(int lowest, int begin, int end, int shift, int width, const Kernel kernel)
{
    for (int level = begin; level < end; ++level) {
        const int first = int(blockIdx.x) << (shift - level);
        const int last = min(first + (1 << (shift - level)), level_size(lowest, level));
        for (int k = int(threadIdx.x); k < (last - first) * width; k += int(blockDim.x))
            kernel(int(blockIdx.y), level, first + k / width, k % width);
        __syncthreads();
    }
}

#endif

/// Launches kernel(i, team) for i in [0, count), a team each, in the stream's turn and returns. Counted and
/// refused as parallel_for.
/// @param block  threads of a block, a multiple of Team::kThreads
template <typename Kernel>
void parallel_for_teams(const CudaSpace& space, std::string_view name, int count,
                        [[maybe_unused]] const Kernel& kernel, [[maybe_unused]] int block = 128,
                        CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    run_teams<<<block_count(count, block / Team::kThreads), block, 0, space.stream()>>>(count, kernel);
#endif
    launch.done();
}

/// Launches kernel(tree, level, c, k) for k in [0, width) at every node c of some equal implicit trees,
/// children before parents: a block climbs from kSubtreeNodes nodes to one, then a single one to the root.
/// Item (tree, level, c, k) may write slot k of its node and read all slots of the children.
/// @param trees   at most 65 535
/// @param lowest  nodes of level 0
template <typename Kernel>
void parallel_climb(const CudaSpace& space, std::string_view name, [[maybe_unused]] int trees, int lowest,
                    [[maybe_unused]] int width, [[maybe_unused]] const Kernel& kernel,
                    CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (lowest <= 0 || trees <= 0)
        return;
    int levels = 1;
    while (level_size(lowest, levels - 1) > 1)
        ++levels;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    const int below = std::min(levels, kSubtreeLevels + 1);
    climb<<<dim3(block_count(lowest, kSubtreeNodes), trees), 128, 0, space.stream()>>>(
        lowest, 0, below, kSubtreeLevels, width, kernel);
    if (levels > below)
        climb<<<dim3(1, trees), 512, 0, space.stream()>>>(lowest, below, levels, levels - 1, width, kernel);
#endif
    launch.done();
}

} // namespace toile
