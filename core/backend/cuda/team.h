#pragma once

#include "core/backend/types.h"

/// Threads that share an item, as the kernels launched by teams.cuh see them.
namespace toile {

inline constexpr int kWarp = 32; ///< threads that a GPU runs in step

/// Some neighbouring threads of a warp that share an item.
template <int Threads>
struct TeamOf {
    static constexpr int kThreads = Threads;
    static_assert(Threads >= 2 && Threads <= kWarp && (Threads & (Threads - 1)) == 0);

    int thread; ///< [0, kThreads)

    /// On a GPU only: a single thread of the CPU gets its own value back.
    /// Sum over the threads whose number leaves the same remainder by `stride`, a power of two; all of them
    /// get it. Pairs in a tree: the same bits in every run.
    template <typename Number>
    TOILE_HD Number sum([[maybe_unused]] int stride, Number value) const
    {
#ifdef __CUDA_ARCH__
        for (int offset = kThreads / 2; offset >= stride; offset /= 2)
            value += __shfl_xor_sync(0xffffffffU, value, offset);
#endif
        return value;
    }
};

/// A whole warp.
using Team = TeamOf<kWarp>;

/// The threads of a block that share an item, and memory of their own beside it.
template <int Threads>
struct Block {
    static constexpr int kThreads = Threads;

    int thread;   ///< [0, kThreads)
    void* memory; ///< as many bytes as the launch asked for, shared by the block

    /// Until all threads of the block are here.
    TOILE_HD void wait() const
    {
#ifdef __CUDA_ARCH__
        __syncthreads();
#endif
    }
};

} // namespace toile
