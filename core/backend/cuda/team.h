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

    /// On a GPU only, as above: thread k gets the sum of number k over all threads; for a whole warp. In
    /// every step a thread passes half of its numbers on and takes over the other half: 31 exchanges, not 5 a
    /// number.
    template <typename Number, int Count>
    TOILE_HD Number sum_each(const Number (&numbers)[Count]) const
    {
        static_assert(kThreads == kWarp && Count <= kWarp);
        Number all[kWarp];
        for (int k = 0; k < kWarp; ++k)
            all[k] = k < Count ? numbers[k] : Number(0);
#ifdef __CUDA_ARCH__
        exchange<kWarp / 2>(all);
        return all[0];
#else
        return all[thread];
#endif
    }

private:
#ifdef __CUDA_ARCH__
    template <int Half, typename Number>
    __device__ void exchange(Number (&numbers)[kWarp]) const
    {
        const bool is_upper = (thread & Half) != 0;
#pragma unroll
        for (int k = 0; k < Half; ++k) {
            const Number low = numbers[k], high = numbers[k + Half];
            const Number taken = __shfl_xor_sync(0xffffffffU, is_upper ? low : high, Half);
            numbers[k] = (is_upper ? high : low) + taken;
        }
        if constexpr (Half > 1)
            exchange<Half / 2>(numbers);
    }
#endif
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
