#pragma once

/// parallel_for and parallel_sum on a GPU. Included by .cu files, which hold nothing but launches: the
/// kernels are the structs that the CPU runs too (style: one source per kernel).
///
/// In a build without CUDA the same .cu files are compiled as C++. Nothing here runs then, since no CudaSpace
/// can be made.

#if !defined(__CUDACC__) && !defined(TOILE_CU_AS_CXX)
#error                                                                                                       \
    "kernels are launched in .cu files, listed under CUDA in CMakeLists.txt; a .cpp file would launch nothing"
#endif

#include <algorithm>
#include <string_view>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/device.h"
#include "core/backend/cuda/layout.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/backend/stages.h"
#include "core/backend/types.h"

namespace toile {

/// Holds every .cu file to the layout of the .cpp files (layout.h).
[[gnu::used]] static void (*const kEigenLayoutAgrees)() = &OurEigenLayout::agreed;

/// Threads of a block and items of a block in a sum. They decide how it rounds, whatever the device.
inline constexpr int kSumThreads = 256;
inline constexpr int kSumItems = 2048;

/// Blocks of `size` items that hold `count` items.
inline int block_count(int count, int size) { return count / size + (count % size != 0 ? 1 : 0); }

#ifdef __CUDACC__

template <typename Kernel>
__global__ void run_each(int count, const Kernel kernel)
{
    const long i = long(blockIdx.x) * blockDim.x + threadIdx.x;
    if (i < count)
        kernel(int(i));
}

/// Block b writes to sums[b] the terms of items [b * items, (b + 1) * items): every thread its share in
/// order, then the threads' sums in a tree.
template <typename T, typename Term>
__global__ void __launch_bounds__(kSumThreads)
    sum_blocks(int count, int items, const T zero, const Term term, const View<T> sums)
{
    // Raw bytes: shared memory may not have constructors.
    static_assert(sizeof(T) * kSumThreads <= 48 * 1024, "a block has 48 KiB of shared memory");
    alignas(T) __shared__ unsigned char memory[kSumThreads * sizeof(T)];
    T* const partial = reinterpret_cast<T*>(memory);

    const int thread = int(threadIdx.x);
    const long first = long(blockIdx.x) * items;
    const long end = first + items < count ? first + items : count;
    T sum = zero;
    for (long i = first + thread; i < end; i += kSumThreads)
        sum += term(int(i));
    partial[thread] = sum;
    __syncthreads();

    for (int width = kSumThreads / 2; width > 0; width /= 2) {
        if (thread < width)
            partial[thread] += partial[thread + width];
        __syncthreads();
    }
    if (thread == 0)
        sums[int(blockIdx.x)] = partial[0];
}

#endif

/// Launches kernel(i) for i in [0, count) in the stream's turn and returns. Item i may write slot i only.
/// Counted as one call of stage `name`, whose time is that of the launch and not of the kernel (DeviceTimer
/// measures that). An empty range launches nothing.
/// @param kernel  a named struct of views of device memory, copied; at most 4 KiB
/// @param name    a literal
/// @param block   threads of a block, at most 1024
/// @throws DeviceError naming kernel, file and line when the launch is refused.
template <typename Kernel>
void parallel_for(const CudaSpace& space, std::string_view name, int count,
                  [[maybe_unused]] const Kernel& kernel, [[maybe_unused]] int block = 256,
                  CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (count <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    run_each<<<block_count(count, block), block, 0, space.stream()>>>(count, kernel);
#endif
    launch.done();
}

/// One launch of sum_blocks().
template <typename T, typename Term>
void launch_sum(const CudaSpace& space, std::string_view name, [[maybe_unused]] int count,
                [[maybe_unused]] int items, [[maybe_unused]] const T& zero, [[maybe_unused]] const Term& term,
                [[maybe_unused]] View<T> sums, CallSite where)
{
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    sum_blocks<<<std::max(block_count(count, items), 1), kSumThreads, 0, space.stream()>>>(count, items, zero,
                                                                                           term, sums);
#endif
    launch.done();
}

/// Item i of an array, as the term of a sum.
template <typename T>
struct ItemOf {
    View<const T> items;
    TOILE_HD const T& operator()(int i) const { return items[i]; }
};

/// Writes the sum of term(i) over [0, count) to slot[0] on the device, in the stream's turn; nothing is read
/// back. Blocks of kSumItems items in trees, then the block sums by one block: two kernels, one where a block
/// holds all. The same bits in every run and on every device, but not those of the CPU's parallel_sum, which
/// adds in another order. An empty range gives `zero`.
/// @param zero        what changes no sum
/// @param slot        [1]
/// @param block_sums  scratch; grows to one item per block
template <typename T, typename Term>
void parallel_sum(const CudaSpace& space, std::string_view name, int count, const T& zero, const Term& term,
                  View<T> slot, DeviceArray<T>& block_sums, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    const int blocks = block_count(std::max(count, 0), kSumItems);
    if (blocks <= 1)
        return launch_sum(space, name, count, kSumItems, zero, term, slot, where);
    if (block_sums.size() < blocks)
        block_sums.resize(blocks);
    const View<T> sums = block_sums.view();
    launch_sum(space, name, count, kSumItems, zero, term, sums, where);
    launch_sum(space, name, blocks, blocks, zero, ItemOf<T>{sums}, slot, where);
}

/// The same sum, waited for and read back. An empty range launches nothing.
template <typename T, typename Term>
T parallel_sum(const CudaSpace& space, std::string_view name, int count, const T& zero, const Term& term,
               SumScratch<T>& scratch, CallSite where = CallSite::here())
{
    if (count <= 0)
        return zero;
    parallel_sum(space, name, count, zero, term, scratch.total.view(), scratch.block_sums, where);
    scratch.total.download(scratch.value.view());
    space.synchronise(where);
    return scratch.value[0];
}

} // namespace toile
