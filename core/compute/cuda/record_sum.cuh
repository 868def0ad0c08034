#pragma once

/// Sums of records of many numbers on a GPU, and decisions based on them, in one kernel. Included by .cu
/// files, as parallel.cuh.

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/compute/cuda/parallel.cuh"

namespace toile {

/// Record in the form in which a warp adds it up: one number per lane.
template <typename T>
struct RecordLanes {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(double) == 0);
    static constexpr int kNumbers = int(sizeof(T) / sizeof(double));
    static_assert(kNumbers <= kWarp);

#ifdef __CUDACC__
    /// Sum or maximum of one number of two records.
    __device__ static double combined(double a, double b, bool is_largest)
    {
        return is_largest ? fmax(a, b) : a + b;
    }

    /// Reduces and scatters: every lane passes on half of its numbers and takes over the other lane's other
    /// half, then a quarter, and so on. That takes 31 exchanges, not 5 a number. At the end numbers[0] of
    /// lane k is number k, combined over all lanes.
    template <int Half>
    __device__ static void exchange(double (&numbers)[kWarp], int lane)
    {
        const bool is_upper = (lane & Half) != 0;
        const bool has_largest = (lane & ~(Half - 1)) == (T::kLargest & ~(Half - 1));
#pragma unroll
        for (int k = 0; k < Half; ++k) {
            const double low = numbers[k], high = numbers[k + Half];
            const double taken = __shfl_xor_sync(0xffffffffU, is_upper ? low : high, Half);
            numbers[k] = combined(is_upper ? high : low, taken, k == T::kLargest % Half && has_largest);
        }
        if constexpr (Half > 1)
            exchange<Half / 2>(numbers, lane);
    }

    /// Number `lane` of the records of all lanes, combined.
    __device__ static double of_warp(const T& record, int lane)
    {
        double numbers[kWarp];
#pragma unroll
        for (int k = 0; k < kWarp; ++k)
            numbers[k] = k < kNumbers ? reinterpret_cast<const double*>(&record)[k] : 0.0;
        exchange<kWarp / 2>(numbers, lane);
        return numbers[0];
    }

    /// Number `lane` of all warps, combined in their order; valid in the first warp.
    __device__ static double of_block(double number, double (&of_warps)[kRecordThreads / kWarp][kWarp])
    {
        const int lane = int(threadIdx.x) % kWarp, warp = int(threadIdx.x) / kWarp;
        of_warps[warp][lane] = number;
        __syncthreads();
        double sum = of_warps[0][lane];
        if (warp == 0)
            for (int w = 1; w < kRecordThreads / kWarp; ++w)
                sum = combined(sum, of_warps[w][lane], lane == T::kLargest);
        __syncthreads();
        return sum;
    }
#endif
};

#ifdef __CUDACC__

/// @param block_sums, finished  of RecordScratch; `finished` counts blocks, and is 0 before and after
template <typename T, typename Term, typename Then>
__global__ void __launch_bounds__(kRecordThreads)
    sum_records(int count, const Term term, const Then then, double* block_sums, unsigned* finished)
{
    using Lanes = RecordLanes<T>;
    __shared__ double of_warps[kRecordThreads / kWarp][kWarp];
    __shared__ bool is_last;
    const int lane = int(threadIdx.x) % kWarp, warp = int(threadIdx.x) / kWarp;
    T record{};
    long i = long(blockIdx.x) * kRecordThreads + threadIdx.x;
    const long stride = long(gridDim.x) * kRecordThreads;
    if constexpr (HasPrologue<Term, int>) {
        const auto local = term.prologue(int(i < count ? i : 0));
        grid_dependency_wait();
        if (i < count)
            record = term(int(i), local);
        i += stride;
    } else {
        grid_dependency_wait();
    }
    for (; i < count; i += stride)
        record += term(int(i));
    const double local = Lanes::of_block(Lanes::of_warp(record, lane), of_warps);
    if (warp == 0) {
        block_sums[blockIdx.x * kWarp + lane] = local;
        __threadfence();
        __syncwarp();
        if (lane == 0)
            is_last = atomicInc(finished, gridDim.x - 1) == gridDim.x - 1;
    }
    __syncthreads();
    if (!is_last)
        return;

    // The last block to finish adds up the sums of all blocks: each warp a strided subset, then the warps in
    // order. All sums are loaded before the first is waited for.
    __threadfence();
    constexpr int kWarps = kRecordThreads / kWarp, kOfWarp = (kRecordBlocks + kWarps - 1) / kWarps;
    double sums[kOfWarp];
#pragma unroll
    for (int n = 0; n < kOfWarp; ++n) {
        const unsigned b = warp + n * kWarps;
        sums[n] = b < gridDim.x ? __ldcg(&block_sums[b * kWarp + lane]) : 0.0;
    }
    double sum = 0.0;
#pragma unroll
    for (int n = 0; n < kOfWarp; ++n)
        sum = Lanes::combined(sum, sums[n], lane == T::kLargest);
    sum = Lanes::of_block(sum, of_warps);
    if (warp == 0)
        of_warps[0][lane] = sum;
    __syncthreads();
    if (threadIdx.x == 0) {
        T total;
        memcpy(static_cast<void*>(&total), &of_warps[0][0], sizeof(T));
        then(total);
    }
}

#endif

/// Sums the records term(i) over [0, count) and calls then(sum) once on the device, by one thread, in stream
/// order. Nothing is read back. One kernel, with the same bits in every run and on every device.
/// @tparam T    at most 32 doubles and nothing else, all 0 by default, with +=. Number T::kLargest (-1: none)
///              is a maximum of non-negative numbers, not a sum.
/// @param term  may also write slot i of arrays
template <typename T, typename Term, typename Then>
void parallel_sum_record_then(const CudaSpace& space, std::string_view name, int count,
                              [[maybe_unused]] const Term& term, [[maybe_unused]] const Then& then,
                              [[maybe_unused]] RecordScratch& scratch, CallSite where = CallSite::here())
{
    static_assert(RecordLanes<T>::kNumbers > T::kLargest);
    const StageScope stage(name);
    [[maybe_unused]] const int blocks = std::clamp(block_count(count, kRecordThreads), 1, kRecordBlocks);
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, sum_records<T, Term, Then>, blocks, kRecordThreads, 0, count, term, then,
                  scratch.block_sums.view().data(), scratch.finished.view().data());
#endif
    launch.done();
}

} // namespace toile
