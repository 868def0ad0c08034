#pragma once

/// Launches on a GPU in which threads work together on one item: some of a warp, or a whole block. Included
/// by .cu files, as parallel.cuh.

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/team.h"

namespace toile {

/// A kernel and how many items it has.
template <typename Kernel>
struct CountedKernel {
    Kernel kernel;
    int count = 0;
};

/// Some of a kind that one launch takes side by side.
template <typename Kernel>
struct KernelsBeside {
    static constexpr int kParameterBytes = 4096 - 128;
    static constexpr int kMost = std::min(8, kParameterBytes / int(sizeof(CountedKernel<Kernel>) + 4));

    CountedKernel<Kernel> all[kMost];
    int end_block[kMost]; ///< behind the blocks of each

    /// Number of the kernel that a block runs.
    TOILE_HD int of_block(int block) const
    {
        int k = 0;
        while (block >= end_block[k])
            ++k;
        return k;
    }
    TOILE_HD int first_block(int k) const { return k == 0 ? 0 : end_block[k - 1]; }
};

#ifdef __CUDACC__

template <int Threads, typename Kernel>
__device__ void run_team(int block, int count, const Kernel& kernel)
{
    // No thread leaves early: sums of a warp take all of its threads.
    const long item = (long(block) * blockDim.x + threadIdx.x) / Threads;
    run_in_turn(kernel, int(item < count ? item : count - 1), TeamOf<Threads>{int(threadIdx.x) % Threads},
                item < count);
}

template <int Threads, typename Kernel>
__global__ void run_teams(int count, const Kernel kernel)
{
    run_team<Threads>(int(blockIdx.x), count, kernel);
}

template <int Threads, typename Kernel>
__global__ void run_teams_beside(const __grid_constant__ KernelsBeside<Kernel> beside)
{
    const int k = beside.of_block(int(blockIdx.x));
    run_team<Threads>(int(blockIdx.x) - beside.first_block(k), beside.all[k].count, beside.all[k].kernel);
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads) run_blocks(const Kernel kernel)
{
    extern __shared__ float4 memory[];
    run_in_turn(kernel, int(blockIdx.x), Block<Threads>{int(threadIdx.x), memory});
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads)
    run_blocks_beside(const __grid_constant__ KernelsBeside<Kernel> beside)
{
    extern __shared__ float4 memory[];
    const int k = beside.of_block(int(blockIdx.x));
    run_in_turn(beside.all[k].kernel, int(blockIdx.x) - beside.first_block(k),
                Block<Threads>{int(threadIdx.x), memory});
}

#endif

/// Calls launch(some of them, blocks) until all kernels have been launched.
/// @param blocks_of  items -> blocks
template <typename Kernel, typename BlocksOf, typename Launch>
void launch_beside(const std::vector<CountedKernel<Kernel>>& kernels, const BlocksOf& blocks_of,
                   const Launch& launch)
{
    const int count = int(kernels.size()), most = KernelsBeside<Kernel>::kMost;
    for (int first = 0; first < count; first += most) {
        KernelsBeside<Kernel> beside;
        int blocks = 0;
        for (int k = first; k < std::min(first + most, count); ++k) {
            beside.all[k - first] = kernels[k];
            blocks += blocks_of(kernels[k].count);
            beside.end_block[k - first] = blocks;
        }
        launch(beside, blocks);
    }
}

/// Launches kernel(i, team, is_own) for i in [0, count), a team each, in the stream's turn and returns. Where
/// a warp has more teams than items are left, others do the last item too, with is_own false, and write
/// nothing. Counted and refused as parallel_for.
/// @param block  threads of a block, a multiple of kWarp
template <int Threads = kWarp, typename Kernel>
void parallel_for_teams(const CudaSpace& space, std::string_view name, int count,
                        [[maybe_unused]] const Kernel& kernel, [[maybe_unused]] int block = 128,
                        CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, run_teams<Threads, Kernel>, block_count(count, block / Threads), block, 0, count,
                  kernel);
#endif
    launch.done();
}

/// The same of several kernels side by side, none of which needs what another finds: one launch, or a few
/// where there are many.
template <int Threads, typename Kernel>
void parallel_for_teams(const CudaSpace& space, std::string_view name,
                        const std::vector<CountedKernel<Kernel>>& kernels, int block = 128,
                        CallSite where = CallSite::here())
{
    if (kernels.size() == 1)
        return parallel_for_teams<Threads>(space, name, kernels[0].count, kernels[0].kernel, block, where);
    const StageScope stage(name);
    launch_beside(
        kernels, [&](int count) { return block_count(count, block / Threads); },
        [&]([[maybe_unused]] const KernelsBeside<Kernel>& beside, [[maybe_unused]] int blocks) {
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_teams_beside<Threads, Kernel>, blocks, block, 0, beside);
#endif
            launch.done();
        });
}

/// Launches kernel(i, block) for i in [0, count), a block of threads each, in the stream's turn and returns.
/// Counted and refused as parallel_for.
/// @param shared_bytes  of Block::memory, at most 48 KiB
template <int Threads, typename Kernel>
void parallel_for_blocks(const CudaSpace& space, std::string_view name, [[maybe_unused]] int count,
                         [[maybe_unused]] std::size_t shared_bytes, [[maybe_unused]] const Kernel& kernel,
                         CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, run_blocks<Threads, Kernel>, count, Threads, shared_bytes, kernel);
#endif
    launch.done();
}

/// The same of several kernels side by side, as parallel_for_teams.
template <int Threads, typename Kernel>
void parallel_for_blocks(const CudaSpace& space, std::string_view name,
                         const std::vector<CountedKernel<Kernel>>& kernels, std::size_t shared_bytes,
                         CallSite where = CallSite::here())
{
    if (kernels.size() == 1)
        return parallel_for_blocks<Threads>(space, name, kernels[0].count, shared_bytes, kernels[0].kernel,
                                            where);
    const StageScope stage(name);
    launch_beside(
        kernels, [](int count) { return count; },
        [&]([[maybe_unused]] const KernelsBeside<Kernel>& beside, [[maybe_unused]] int blocks) {
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_blocks_beside<Threads, Kernel>, blocks, Threads, shared_bytes, beside);
#endif
            launch.done();
        });
}

} // namespace toile
