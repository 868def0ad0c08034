#pragma once

/// Launches on a GPU in which threads share an item: some threads of a warp, or a whole block. Included by
/// .cu files, as parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/team.h"

namespace toile {

/// Kernel and its number of items, none at first.
template <typename Kernel>
struct CountedKernel {
    Kernel kernel;
    int count = 0;
};

/// Kernels of one type that one launch runs side by side. A larger capacity costs the host time in every
/// launch.
template <typename Kernel, int Capacity>
struct KernelBatch {
    static_assert(Capacity >= 1, "a kernel has too many parameters to be launched");

    CountedKernel<Kernel> all[Capacity];
    int end_block[Capacity]; ///< end of the blocks of each kernel
    int size = 0;

    int blocks() const { return size == 0 ? 0 : end_block[size - 1]; }
    void add(const CountedKernel<Kernel>& kernel, int blocks)
    {
        const int before = this->blocks();
        all[size] = kernel;
        end_block[size++] = before + blocks;
    }

    /// Index of the kernel that a block runs.
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
    // No thread returns early: warp sums take all threads.
    const long item = (long(block) * blockDim.x + threadIdx.x) / Threads;
    run_after_dependency(kernel, int(item < count ? item : count - 1),
                         TeamOf<Threads>{int(threadIdx.x) % Threads}, item < count);
}

template <int Threads, typename Kernel>
__global__ void run_teams(int count, const Kernel kernel)
{
    run_team<Threads>(int(blockIdx.x), count, kernel);
}

template <int Threads, typename Kernel, int Capacity>
__global__ void run_teams_batch(const __grid_constant__ KernelBatch<Kernel, Capacity> batch)
{
    const int k = batch.of_block(int(blockIdx.x));
    run_team<Threads>(int(blockIdx.x) - batch.first_block(k), batch.all[k].count, batch.all[k].kernel);
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads) run_blocks(const Kernel kernel)
{
    extern __shared__ float4 memory[];
    run_after_dependency(kernel, int(blockIdx.x), Block<Threads>{int(threadIdx.x), memory});
}

template <int Threads, typename Kernel, int Capacity>
__global__ void __launch_bounds__(Threads)
    run_blocks_batch(const __grid_constant__ KernelBatch<Kernel, Capacity> batch)
{
    extern __shared__ float4 memory[];
    const int k = batch.of_block(int(blockIdx.x));
    run_after_dependency(batch.all[k].kernel, int(blockIdx.x) - batch.first_block(k),
                         Block<Threads>{int(threadIdx.x), memory});
}

#endif

/// Calls launch(batch) with all of kernel_at(0 .. size - 1) that have items, in batches of at most
/// `Capacity`.
template <typename Kernel, int Capacity, typename KernelAt, typename BlocksOf, typename Launch>
void launch_batches_of(int size, const KernelAt& kernel_at, const BlocksOf& blocks_of, const Launch& launch)
{
    KernelBatch<Kernel, Capacity> batch;
    for (int k = 0; k < size; ++k) {
        const CountedKernel<Kernel> kernel = kernel_at(k);
        if (kernel.count <= 0)
            continue;
        if (batch.size == Capacity) {
            launch(batch);
            batch.size = 0;
        }
        batch.add(kernel, blocks_of(kernel.count));
    }
    if (batch.size > 0)
        launch(batch);
}

/// The same, in one batch or, if there are many kernels, a few.
/// @param blocks_of  items -> blocks
template <typename Kernel, typename KernelAt, typename BlocksOf, typename Launch>
void launch_batches(int size, const KernelAt& kernel_at, const BlocksOf& blocks_of, const Launch& launch)
{
    constexpr int kParameterBytes = 4096; ///< limit of a launch
    constexpr int kLargest = (kParameterBytes - 8) / int(sizeof(CountedKernel<Kernel>) + sizeof(int));
    constexpr int kSmall = std::min(4, kLargest);
    if (size <= kSmall)
        launch_batches_of<Kernel, kSmall>(size, kernel_at, blocks_of, launch);
    else
        launch_batches_of<Kernel, kLargest>(size, kernel_at, blocks_of, launch);
}

/// Launches kernel(i, team, is_in_range) for i in [0, count), a team each, in stream order and returns.
/// Surplus teams of the last warps repeat the last item with is_in_range false, and write nothing. Counts and
/// throws as parallel_for.
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

/// Launches several independent kernels side by side, as parallel_for_teams: one launch, or a few if there
/// are many.
/// @param kernel_at  k -> CountedKernel<Kernel>, for k in [0, size)
template <int Threads, typename Kernel, typename KernelAt>
void parallel_for_teams(const CudaSpace& space, std::string_view name, int size, const KernelAt& kernel_at,
                        int block = 128, CallSite where = CallSite::here())
{
    launch_batches<Kernel>(
        size, kernel_at, [&](int count) { return block_count(count, block / Threads); },
        [&]<int Capacity>(const KernelBatch<Kernel, Capacity>& batch) {
            if (batch.size == 1)
                return parallel_for_teams<Threads>(space, name, batch.all[0].count, batch.all[0].kernel,
                                                   block, where);
            const StageScope stage(name);
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_teams_batch<Threads, Kernel, Capacity>, batch.blocks(), block, 0, batch);
#endif
            launch.done();
        });
}

/// Launches kernel(i, block) for i in [0, count), a block of threads each, in stream order and returns.
/// Counts and throws as parallel_for.
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

/// Launches several independent kernels side by side, as parallel_for_blocks.
template <int Threads, typename Kernel, typename KernelAt>
void parallel_for_blocks(const CudaSpace& space, std::string_view name, int size, const KernelAt& kernel_at,
                         std::size_t shared_bytes, CallSite where = CallSite::here())
{
    launch_batches<Kernel>(
        size, kernel_at, [](int count) { return count; },
        [&]<int Capacity>(const KernelBatch<Kernel, Capacity>& batch) {
            if (batch.size == 1)
                return parallel_for_blocks<Threads>(space, name, batch.all[0].count, shared_bytes,
                                                    batch.all[0].kernel, where);
            const StageScope stage(name);
            const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
            launch_kernel(space, run_blocks_batch<Threads, Kernel, Capacity>, batch.blocks(), Threads,
                          shared_bytes, batch);
#endif
            launch.done();
        });
}

} // namespace toile
