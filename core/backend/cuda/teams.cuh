#pragma once

/// Launches on a GPU in which threads work together on one item: some of a warp, or a whole block. Included
/// by .cu files, as parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/team.h"

namespace toile {

/// A kernel and how many items it has, none at first.
template <typename Kernel>
struct CountedKernel {
    Kernel kernel;
    int count = 0;
};

/// Kernels of a kind that one launch takes side by side. Room for more costs the host time in every launch.
template <typename Kernel>
struct KernelBatch {
    static constexpr int kParameterBytes = 4096; ///< that a launch can take
    static constexpr int kMost =
        std::min(4, (kParameterBytes - 8) / int(sizeof(CountedKernel<Kernel>) + sizeof(int)));
    static_assert(kMost >= 1, "a kernel has too many parameters to be launched");

    CountedKernel<Kernel> all[kMost];
    int end_block[kMost]; ///< behind the blocks of each
    int size = 0;

    int blocks() const { return size == 0 ? 0 : end_block[size - 1]; }
    void add(const CountedKernel<Kernel>& kernel, int blocks)
    {
        const int before = this->blocks();
        all[size] = kernel;
        end_block[size++] = before + blocks;
    }

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
__global__ void run_teams_batch(const __grid_constant__ KernelBatch<Kernel> batch)
{
    const int k = batch.of_block(int(blockIdx.x));
    run_team<Threads>(int(blockIdx.x) - batch.first_block(k), batch.all[k].count, batch.all[k].kernel);
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads) run_blocks(const Kernel kernel)
{
    extern __shared__ float4 memory[];
    run_in_turn(kernel, int(blockIdx.x), Block<Threads>{int(threadIdx.x), memory});
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads) run_blocks_batch(const __grid_constant__ KernelBatch<Kernel> batch)
{
    extern __shared__ float4 memory[];
    const int k = batch.of_block(int(blockIdx.x));
    run_in_turn(batch.all[k].kernel, int(blockIdx.x) - batch.first_block(k),
                Block<Threads>{int(threadIdx.x), memory});
}

#endif

/// Calls launch(batch) with all of kernel_at(0 .. size - 1) that have items, a batch or more.
/// @param blocks_of  items -> blocks
template <typename Kernel, typename KernelAt, typename BlocksOf, typename Launch>
void launch_batches(int size, const KernelAt& kernel_at, const BlocksOf& blocks_of, const Launch& launch)
{
    KernelBatch<Kernel> batch;
    for (int k = 0; k < size; ++k) {
        const CountedKernel<Kernel> kernel = kernel_at(k);
        if (kernel.count <= 0)
            continue;
        if (batch.size == KernelBatch<Kernel>::kMost) {
            launch(batch);
            batch.size = 0;
        }
        batch.add(kernel, blocks_of(kernel.count));
    }
    if (batch.size > 0)
        launch(batch);
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
/// @param kernel_at  k -> CountedKernel<Kernel>, for k in [0, size)
template <int Threads, typename Kernel, typename KernelAt>
void parallel_for_teams(const CudaSpace& space, std::string_view name, int size, const KernelAt& kernel_at,
                        int block = 128, CallSite where = CallSite::here())
{
    launch_batches<Kernel>(
        size, kernel_at, [&](int count) { return block_count(count, block / Threads); },
        [&](const KernelBatch<Kernel>& batch) {
            if (batch.size == 1)
                return parallel_for_teams<Threads>(space, name, batch.all[0].count, batch.all[0].kernel,
                                                   block, where);
            const StageScope stage(name);
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_teams_batch<Threads, Kernel>, batch.blocks(), block, 0, batch);
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
template <int Threads, typename Kernel, typename KernelAt>
void parallel_for_blocks(const CudaSpace& space, std::string_view name, int size, const KernelAt& kernel_at,
                         std::size_t shared_bytes, CallSite where = CallSite::here())
{
    launch_batches<Kernel>(
        size, kernel_at, [](int count) { return count; },
        [&](const KernelBatch<Kernel>& batch) {
            if (batch.size == 1)
                return parallel_for_blocks<Threads>(space, name, batch.all[0].count, shared_bytes,
                                                    batch.all[0].kernel, where);
            const StageScope stage(name);
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_blocks_batch<Threads, Kernel>, batch.blocks(), Threads, shared_bytes,
                          batch);
#endif
            launch.done();
        });
}

} // namespace toile
