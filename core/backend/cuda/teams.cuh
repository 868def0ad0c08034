#pragma once

/// Launches on a GPU in which threads work together on one item: some of a warp, or a whole block. Included
/// by .cu files, as parallel.cuh.

#include <string_view>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/cuda/team.h"

namespace toile {

#ifdef __CUDACC__

template <int Threads, typename Kernel>
__global__ void run_teams(int count, const Kernel kernel)
{
    // No thread leaves early: sums of a warp take all of its threads.
    const long item = (long(blockIdx.x) * blockDim.x + threadIdx.x) / Threads;
    run_in_turn(kernel, int(item < count ? item : count - 1), TeamOf<Threads>{int(threadIdx.x) % Threads},
                item < count);
}

template <int Threads, typename Kernel>
__global__ void __launch_bounds__(Threads) run_blocks(const Kernel kernel)
{
    extern __shared__ float4 memory[];
    run_in_turn(kernel, int(blockIdx.x), Block<Threads>{int(threadIdx.x), memory});
}

#endif

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

} // namespace toile
