#pragma once

/// parallel_for and parallel_sum on a GPU. Included by .cu files, which hold nothing but launches: the
/// kernels are the structs that the CPU runs too (style: one source per kernel).
///
/// In a build without CUDA the same .cu files are compiled as C++. Nothing here runs then, since no CudaSpace
/// can be constructed.

#if !defined(__CUDACC__) && !defined(TOILE_CU_AS_CXX)
#error                                                                                                       \
    "kernels are launched in .cu files, listed under CUDA in CMakeLists.txt; a .cpp file would launch nothing"
#endif

#include <algorithm>
#include <string_view>

#include "core/base/stages.h"
#include "core/compute/cuda/array.h"
#include "core/compute/cuda/launch.cuh"
#include "core/compute/cuda/layout.h"
#include "core/compute/cuda/runtime/device.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/compute/team.h"
#include "core/compute/types.h"

namespace toile {

/// Forces every .cu file to the layout of the .cpp files (layout.h).
[[gnu::used]] static void (*const kEigenLayoutAgrees)() = &OurEigenLayout::agreed;

/// Threads and items of a block in a sum. They decide how it rounds, on every device alike. Blocks have few
/// items, because other kernels wait for sums, whose time is that of the longest chain of additions.
inline constexpr int kSumThreads = 256;
inline constexpr int kSumItems = 256;

/// Min blocks of a sum on a multiprocessor: large terms get fewer registers.
inline constexpr int kSumBlocksAtOnce = 2;

/// Number of blocks of `size` items that hold `count` items.
inline int block_count(int count, int size) { return count / size + (count % size != 0 ? 1 : 0); }

#ifdef __CUDACC__

template <typename Kernel>
__global__ void run_each(int count, const Kernel kernel)
{
    const long i = long(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < count)
        run_after_dependency(kernel, int(i));
}

/// Value of the thread whose index differs in the bits of `mask`.
template <typename T>
__device__ T value_across(const T& value, int mask)
{
    static_assert(sizeof(T) % sizeof(unsigned) == 0);
    constexpr int kWords = sizeof(T) / sizeof(unsigned);
    unsigned words[kWords];
    memcpy(words, &value, sizeof(T));
#pragma unroll
    for (int w = 0; w < kWords; ++w)
        words[w] = __shfl_xor_sync(0xffffffffU, words[w], mask);
    T across = value;
    memcpy(static_cast<void*>(&across), words, sizeof(T));
    return across;
}

/// Calls then(b, sum) in block b with the sum over items [b * items, (b + 1) * items). Every thread adds its
/// terms in order; then the threads of a warp are added in a tree, then the warps.
template <typename T, typename Term, typename Then>
__global__ void __launch_bounds__(kSumThreads, kSumBlocksAtOnce)
    sum_blocks(int count, int items, const T zero, const Term term, const Then then)
{
    // Raw bytes: shared memory may not have constructors.
    constexpr int kWarps = kSumThreads / kWarp;
    alignas(T) __shared__ unsigned char memory[kWarps * sizeof(T)];
    T* const of_warp = reinterpret_cast<T*>(memory);

    grid_dependency_wait();
    const int thread = int(threadIdx.x);
    const long first = long(blockIdx.x) * items;
    const long end = first + items < count ? first + items : count;
    T sum = zero;
    for (long i = first + thread; i < end; i += kSumThreads)
        sum += term(int(i));
    for (int width = kWarp / 2; width > 0; width /= 2)
        sum += value_across(sum, width);
    if (thread % kWarp == 0)
        of_warp[thread / kWarp] = sum;
    __syncthreads();

    if (thread >= kWarp)
        return;
    sum = of_warp[thread % kWarps];
    for (int width = kWarps / 2; width > 0; width /= 2)
        sum += value_across(sum, width);
    if (thread == 0)
        then(int(blockIdx.x), sum);
}

#endif

/// Launches kernel(i) for i in [0, count) in stream order and returns. Item i may write as on the CPU
/// (core/compute/parallel.h). An empty range launches nothing.
///
/// Counted as one call of stage `name`, whose time is that of the launch and not of the kernel (DeviceTimer
/// measures that).
/// @param kernel  a named struct of views of device memory, copied; at most 4 KiB
/// @param name    a literal
/// @param block   threads of a block, at most 1024
/// @throws DeviceError naming kernel, file and line if the launch is refused.
template <typename Kernel>
void parallel_for(const CudaSpace& space, std::string_view name, int count,
                  [[maybe_unused]] const Kernel& kernel, [[maybe_unused]] int block = 128,
                  CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, run_each<Kernel>, block_count(count, block), block, 0, count, kernel);
#endif
    launch.done();
}

/// Launches sum_blocks() once.
template <typename T, typename Term, typename Then>
void launch_sum(const CudaSpace& space, std::string_view name, [[maybe_unused]] int count,
                [[maybe_unused]] int items, [[maybe_unused]] const T& zero, [[maybe_unused]] const Term& term,
                [[maybe_unused]] const Then& then, CallSite where)
{
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    launch_kernel(space, sum_blocks<T, Term, Then>, std::max(block_count(count, items), 1), kSumThreads, 0,
                  count, items, zero, term, then);
#endif
    launch.done();
}

/// Term of a sum over an array: item i.
template <typename T>
struct ItemOf {
    View<const T> items;
    TOILE_HD const T& operator()(int i) const { return items[i]; }
};

/// Stores the sum of block k in item k.
template <typename T>
struct KeepSum {
    View<T> sums;
    TOILE_HD void operator()(int k, const T& sum) const { sums[k] = sum; }
};

/// Calls then(sum) with the sum of the only block.
template <typename Then>
struct WithTotal {
    Then then;
    template <typename T>
    TOILE_HD void operator()(int, const T& sum) const
    {
        then(sum);
    }
};

/// Sums term(i) over [0, count) and calls then(sum) once on the device, by one thread, in stream order.
/// Nothing is read back. An empty range gives `zero`.
///
/// Blocks of kSumItems items are added in trees, then one block adds the block sums: two kernels, or one if a
/// block holds all items. The bits are the same in every run and on every device. They differ from those of
/// the CPU's parallel_sum, which adds in another order.
/// @param zero        neutral element of the sum
/// @param term        may also write slot i of arrays
/// @param block_sums  scratch; grows to one item per block
template <typename T, typename Term, typename Then>
void parallel_sum_then(const CudaSpace& space, std::string_view name, int count, const T& zero,
                       const Term& term, const Then& then, DeviceArray<T>& block_sums,
                       CallSite where = CallSite::here())
{
    const StageScope stage(name);
    const int blocks = block_count(std::max(count, 0), kSumItems);
    if (blocks <= 1)
        return launch_sum(space, name, count, kSumItems, zero, term, WithTotal<Then>{then}, where);
    if (block_sums.size() < blocks)
        block_sums.resize(blocks);
    const View<T> sums = block_sums.view();
    launch_sum(space, name, count, kSumItems, zero, term, KeepSum<T>{sums}, where);
    launch_sum(space, name, blocks, blocks, zero, ItemOf<T>{sums}, WithTotal<Then>{then}, where);
}

/// Writes a sum to the device for later kernels.
template <typename T>
struct KeepTotal {
    View<T> slot; ///< [1]
    TOILE_HD void operator()(const T& sum) const { slot[0] = sum; }
};

/// Sums likewise, to slot[0] on the device.
template <typename T, typename Term>
void parallel_sum(const CudaSpace& space, std::string_view name, int count, const T& zero, const Term& term,
                  View<T> slot, DeviceArray<T>& block_sums, CallSite where = CallSite::here())
{
    parallel_sum_then(space, name, count, zero, term, KeepTotal<T>{slot}, block_sums, where);
}

/// Sums likewise, waits and reads back. An empty range launches nothing.
template <typename T, typename Term>
T parallel_sum(const CudaSpace& space, std::string_view name, int count, const T& zero, const Term& term,
               SumScratch<T>& scratch, CallSite where = CallSite::here())
{
    if (count <= 0)
        return zero;
    parallel_sum_then(space, name, count, zero, term, scratch.total.next(), scratch.block_sums, where);
    return scratch.total.await(where);
}

} // namespace toile
