#pragma once

#include <algorithm>
#include <array>

#include "core/compute/types.h"

/// Threads that share an item, as seen by the kernels that teams.cuh launches.
namespace toile {

inline constexpr int kWarp = 32; ///< threads that a GPU runs in lockstep

/// Adjacent threads of a warp that share an item.
template <int Threads>
struct TeamOf {
    static constexpr int kThreads = Threads;
    static_assert(Threads >= 2 && Threads <= kWarp && (Threads & (Threads - 1)) == 0);

    int thread; ///< [0, kThreads)

    /// Number of threads of the team; 1 on the CPU.
    TOILE_HD static constexpr int width()
    {
#ifdef __CUDA_ARCH__
        return kThreads;
#else
        return 1;
#endif
    }

    /// Sum over the threads whose index has the same remainder modulo `stride`, a power of two; all of them
    /// get it. Added in pairs, in a tree: the same bits in every run. On the CPU it returns `value`.
    template <typename Number>
    TOILE_HD Number sum([[maybe_unused]] int stride, Number value) const
    {
#ifdef __CUDA_ARCH__
        for (int offset = kThreads / 2; offset >= stride; offset /= 2)
            value += __shfl_xor_sync(0xffffffffU, value, offset);
#endif
        return value;
    }

    /// Waits for all threads; their writes to the block's memory are then visible to all.
    TOILE_HD void wait() const
    {
#ifdef __CUDA_ARCH__
        __syncwarp();
#endif
    }

    /// Number of threads with a set flag: before this one, and in all.
    struct Flagged {
        int before, count;
    };
    TOILE_HD Flagged flagged(bool flag) const
    {
#ifdef __CUDA_ARCH__
        const unsigned mask = ~0U >> (kWarp - kThreads);
        const int first = int(threadIdx.x) % kWarp - thread;
        const unsigned flags = __ballot_sync(mask << first, flag) >> first & mask;
        return {__popc(flags & ((1U << thread) - 1U)), __popc(flags)};
#else
        return {0, flag ? 1 : 0};
#endif
    }

    /// Sums of every number over all threads, reduced and scattered. Each thread gets Count / Parts of the
    /// sums, the first kThreads / Parts threads the first ones. In every step a thread passes on half of its
    /// numbers and takes over the other half, until only its part is left. On the CPU it only selects the
    /// part.
    template <int Parts, typename Number, std::size_t Count>
    TOILE_HD std::array<Number, Count / Parts> reduce_scatter(const std::array<Number, Count>& numbers) const
    {
        static_assert(Count % Parts == 0 && kThreads % Parts == 0);
#ifdef __CUDA_ARCH__
        return reduce_scatter_step<Parts, kThreads / 2>(numbers);
#else
        std::array<Number, Count / Parts> local;
        std::copy_n(numbers.begin() + local.size() * (thread / (kThreads / Parts)), local.size(),
                    local.begin());
        return local;
#endif
    }

private:
#ifdef __CUDA_ARCH__
    template <int Parts, int Half, typename Number, std::size_t Count>
    __device__ std::array<Number, Count / Parts>
    reduce_scatter_step(const std::array<Number, Count>& numbers) const
    {
        if constexpr (Half == 0) {
            return numbers;
        } else if constexpr (Parts == 1) {
            std::array<Number, Count> sums;
#pragma unroll
            for (int k = 0; k < int(Count); ++k)
                sums[k] = numbers[k] + __shfl_xor_sync(0xffffffffU, numbers[k], Half);
            return reduce_scatter_step<1, Half / 2>(sums);
        } else {
            constexpr int kKept = int(Count) / 2;
            const bool is_upper = (thread & Half) != 0;
            std::array<Number, kKept> kept;
#pragma unroll
            for (int k = 0; k < kKept; ++k) {
                const Number low = numbers[k], high = numbers[k + kKept];
                const Number taken = __shfl_xor_sync(0xffffffffU, is_upper ? low : high, Half);
                kept[k] = (is_upper ? high : low) + taken;
            }
            return reduce_scatter_step<Parts / 2, Half / 2>(kept);
        }
    }
#endif
};

/// A whole warp.
using Team = TeamOf<kWarp>;

/// Threads of a block that share an item, and their shared memory.
template <int Threads>
struct Block {
    static constexpr int kThreads = Threads;

    int thread;   ///< [0, kThreads)
    void* memory; ///< as many bytes as the launch asked for, shared by the block

    /// Waits for all threads of the block.
    TOILE_HD void wait() const
    {
#ifdef __CUDA_ARCH__
        __syncthreads();
#endif
    }
};

} // namespace toile
