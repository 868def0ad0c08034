#pragma once

#include <algorithm>
#include <array>

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

    /// Threads that are there: on the CPU this one only.
    TOILE_HD static constexpr int width()
    {
#ifdef __CUDA_ARCH__
        return kThreads;
#else
        return 1;
#endif
    }

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

    /// Until all threads are here; what they have written to the block's memory is seen by all.
    TOILE_HD void wait() const
    {
#ifdef __CUDA_ARCH__
        __syncwarp();
#endif
    }

    /// Where a flag of each thread is set: of how many threads before this one, and of how many in all.
    struct Flagged {
        int before, count;
    };
    TOILE_HD Flagged flagged(bool flag) const
    {
#ifdef __CUDA_ARCH__
        const unsigned own = ~0U >> (kWarp - kThreads);
        const int first = int(threadIdx.x) % kWarp - thread;
        const unsigned flags = __ballot_sync(own << first, flag) >> first & own;
        return {__popc(flags & ((1U << thread) - 1U)), __popc(flags)};
#else
        return {0, flag ? 1 : 0};
#endif
    }

    /// On a GPU only, as above: the sum of every number over all threads, shared out. Threads get Count /
    /// Shares of them, the first kThreads / Shares threads the first. In every step a thread passes half of
    /// its numbers on and takes over the other half, until it has only its share.
    template <int Shares, typename Number, std::size_t Count>
    TOILE_HD std::array<Number, Count / Shares> sum_shares(const std::array<Number, Count>& numbers) const
    {
        static_assert(Count % Shares == 0 && kThreads % Shares == 0);
#ifdef __CUDA_ARCH__
        return shared_out<Shares, kThreads / 2>(numbers);
#else
        std::array<Number, Count / Shares> own;
        std::copy_n(numbers.begin() + own.size() * (thread / (kThreads / Shares)), own.size(), own.begin());
        return own;
#endif
    }

private:
#ifdef __CUDA_ARCH__
    template <int Shares, int Half, typename Number, std::size_t Count>
    __device__ std::array<Number, Count / Shares> shared_out(const std::array<Number, Count>& numbers) const
    {
        if constexpr (Half == 0) {
            return numbers;
        } else if constexpr (Shares == 1) {
            std::array<Number, Count> sums;
#pragma unroll
            for (int k = 0; k < int(Count); ++k)
                sums[k] = numbers[k] + __shfl_xor_sync(0xffffffffU, numbers[k], Half);
            return shared_out<1, Half / 2>(sums);
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
            return shared_out<Shares / 2, Half / 2>(kept);
        }
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
