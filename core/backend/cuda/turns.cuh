#pragma once

/// Launches on a GPU in which items go one after the other as far as they share something. Included by .cu
/// files, as parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/backend/cuda/parallel.cuh"
#include "core/backend/turns.h"

namespace toile {

/// Threads that visit items, at most: no device runs more at once, and more would only wait.
inline constexpr int kVisitors = 8448;

#ifdef __CUDACC__

/// What was written before is seen by whoever sees what is written after; and the other way round.
__device__ inline void order_memory() { asm volatile("fence.acq_rel.gpu;" ::: "memory"); }

/// An item's turn.
class Turn {
public:
    /// @param shared  what the item shares; -1 unused
    __device__ Turn(const Turns& turns, int item, const std::array<int, Turns::kShares>& shared)
        : served_(turns.served.data()), shared_(shared)
    {
        for (int k = 0; k < Turns::kShares; ++k)
            if (shared[k] >= 0)
                before_[k] = turns.rank[Turns::kShares * item + k];
    }

    /// Until all before it have been served; sees what they wrote.
    __device__ void await() const
    {
        while (!has_come()) {
        }
        order_memory();
    }

    __device__ void pass_on() const
    {
        order_memory();
        for (int k = 0; k < Turns::kShares; ++k)
            if (shared_[k] >= 0)
                *at(k) = before_[k] + 1;
    }

private:
    /// Asks for all that it shares at once.
    __device__ bool has_come() const
    {
        int left = 0;
        for (int k = 0; k < Turns::kShares; ++k)
            left |= shared_[k] >= 0 ? *at(k) ^ before_[k] : 0;
        return left == 0;
    }
    __device__ volatile int* at(int k) const { return served_ + shared_[k]; }

    int* served_;
    std::array<int, Turns::kShares> shared_, before_;
};

/// Visits begin in order, so whoever is waited for has begun: however few threads run at once, the first of
/// them need not wait. One thread of a warp works, as the others would wait for it to wait.
template <typename Kernel>
__global__ void run_in_turns(const Turns turns, const Kernel kernel)
{
    wait_for_turn();
    if (threadIdx.x % kWarp != 0)
        return;
    const unsigned count = unsigned(turns.count[0]);
    unsigned* const next = turns.next.data();
    for (unsigned visit = atomicAdd(next, 1U); visit < count; visit = atomicAdd(next, 1U)) {
        const int item = turns.order.at(turns.places[int(visit)]);
        const auto own = kernel.prepare(item);
        const Turn turn(turns, item, kernel.shared(own));
        turn.await();
        kernel(item, own);
        turn.pass_on();
    }
}

#endif

/// Launches kernel(item, kernel.prepare(item)) for all listed items in the stream's turn and returns. Each
/// begins when those before it that share something with it are done, so that the result is that of one after
/// the other. prepare() loads what no item changes, and kernel.shared() tells by that what the item shares
/// with others. Counted and refused as parallel_for.
/// @param turns  next[0] is 0, and nothing has been served
/// @param most   items that may be listed
template <typename Kernel>
void parallel_in_turns(const CudaSpace& space, std::string_view name, [[maybe_unused]] const Turns& turns,
                       int most, [[maybe_unused]] const Kernel& kernel, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (most <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    constexpr int kBlock = 128;
    launch_kernel(space, run_in_turns<Kernel>, block_count(std::min(most, kVisitors), kBlock / kWarp), kBlock,
                  0, turns, kernel);
#endif
    launch.done();
}

} // namespace toile
