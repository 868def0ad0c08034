#pragma once

/// Launches on a GPU in which a block of threads computes one tile of a result in steps and loads later
/// steps' data meanwhile. Included by .cu files, as parallel.cuh.

#include "core/compute/async_copy.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile {

/// Stages of shared memory in a block: one is computed with, the others are being loaded.
inline constexpr int kTileStages = 4;

/// Number of blocks that a multiprocessor should hold: bounds the registers of a thread.
inline constexpr int kTileBlocks = 4;

#ifdef __CUDACC__

template <typename Kernel>
__global__ void __launch_bounds__(Kernel::kThreads, kTileBlocks)
    run_tiles(const __grid_constant__ Kernel kernel)
{
    __shared__ typename Kernel::Stage stages[kTileStages];
    grid_dependency_wait();
    const auto work = kernel.work(int(blockIdx.x), int(threadIdx.x));
    const int steps = work.steps();
    for (int step = 0; step < kTileStages - 1; ++step) {
        if (step < steps)
            work.load(step, stages[step]);
        commit_copies();
    }
    typename Kernel::Sums sums{};
    for (int step = 0; step < steps; ++step) {
        // This step's stage has arrived, and all threads are done with the stage that is loaded next.
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

/// Launches the tiles [0, count) in stream order and returns, with a block of Kernel::kThreads threads each.
/// Counts and throws as parallel_for.
///
/// kernel.work(tile, thread) is one thread's work on a tile. It has
///   steps()           number of steps, the same for all threads;
///   load(step, stage) loads the thread's part of a step by copy_async into the Stage that the block shares;
///   add(stage, sums)  adds the step to the thread's Sums, which begin as zeros;
///   store(sums)       writes what no other tile of the launch reads or writes.
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
