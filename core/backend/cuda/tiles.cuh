#pragma once

/// Launches on a GPU in which a block of threads computes one tile of a result by steps, fetching what the
/// next steps need while it computes. Included by .cu files, as parallel.cuh.

#include "core/backend/cuda/async_copy.h"
#include "core/backend/cuda/parallel.cuh"

namespace toile {

/// Stages of shared memory that a block has: one is computed with, the others are on their way.
inline constexpr int kTileStages = 4;

/// Blocks that a multiprocessor should hold: bounds the registers of a thread.
inline constexpr int kTileBlocks = 4;

#ifdef __CUDACC__

template <typename Kernel>
__global__ void __launch_bounds__(Kernel::kThreads, kTileBlocks)
    run_tiles(const __grid_constant__ Kernel kernel)
{
    __shared__ typename Kernel::Stage stages[kTileStages];
    wait_for_turn();
    const auto work = kernel.work(int(blockIdx.x), int(threadIdx.x));
    const int steps = work.steps();
    for (int step = 0; step < kTileStages - 1; ++step) {
        if (step < steps)
            work.load(step, stages[step]);
        commit_copies();
    }
    typename Kernel::Sums sums{};
    for (int step = 0; step < steps; ++step) {
        // The stage of this step has come, and all threads are done with the one that is loaded next.
        wait_for_copies<kTileStages - 2>();
        __syncthreads();
        const int next = step + kTileStages - 1;
        if (next < steps)
            work.load(next, stages[next % kTileStages]);
        commit_copies();
        work.add(stages[step % kTileStages], sums);
    }
    work.store(sums);
}

#endif

/// Launches the tiles [0, count) in the stream's turn and returns, a block of Kernel::kThreads threads each.
/// Counted and refused as parallel_for.
///
/// kernel.work(tile, thread) is one thread's part of a tile: steps() of them, the same for all threads;
/// load(step, stage) fetches its share of a step into the Stage that the block's threads share, by
/// copy_async; add(stage, sums) adds the step to the thread's Sums, which begin as zeros; store(sums) writes
/// what no other tile of the launch reads or writes.
template <typename Kernel>
void parallel_tiles(const CudaSpace& space, std::string_view name, int count,
                    [[maybe_unused]] const Kernel& kernel, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, run_tiles<Kernel>, count, Kernel::kThreads, 0, kernel);
#endif
    launch.done();
}

} // namespace toile
