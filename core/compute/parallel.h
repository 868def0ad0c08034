#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include "core/base/stages.h"
#include "core/compute/types.h"

namespace toile {

/// Execution space of kernels on the CPU. CudaSpace has the same signatures (see docs/theory/backends.md).
struct CpuSpace {};
inline constexpr CpuSpace kCpu{};

/// Limits the threads of everything in its lifetime; 0 means all of the machine's.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads)
    {
        if (threads > 0)
            control_.emplace(tbb::global_control::max_allowed_parallelism, size_t(threads));
    }

private:
    std::optional<tbb::global_control> control_;
};

/// Number of threads that work may run on now.
inline int thread_count(CpuSpace)
{
    return int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

/// Context of tasks that compute with the floating-point settings of the calling thread. Without it workers
/// keep those of whatever used them last: Embree flushes denormal numbers, so results would depend on the
/// thread.
class CallersContext : public tbb::task_group_context {
public:
    CallersContext() : task_group_context(bound, default_traits | fp_settings) {}
};

/// Items per task. Small enough to balance, large enough to hide the scheduler (about 1 us a task).
inline constexpr int kGrain = 256;

/// Runs kernel(i) for i in [0, count), in any order, on all threads of the caller's TBB arena. Counted as one
/// call of stage `name`.
///
/// Item i may write only slot i, or shared bounds (shared_bounds.h), so the result has the same bits for
/// every thread count.
/// @param grain  items per task
template <typename Kernel>
void parallel_for(CpuSpace, std::string_view name, int count, const Kernel& kernel, int grain = kGrain)
{
    const StageScope stage(name);
    if (count <= grain) {
        for (int i = 0; i < count; ++i)
            kernel(i);
        return;
    }
    CallersContext context;
    tbb::parallel_for(
        tbb::blocked_range<int>(0, count, grain),
        [&](const tbb::blocked_range<int>& range) {
            for (int i = range.begin(); i < range.end(); ++i)
                kernel(i);
        },
        context);
}

/// Runs work(task) for task in [0, count): few and long tasks, balanced one by one. The calling thread takes
/// no other work while it waits, so tasks may use its thread-local memory.
template <typename Work>
void parallel_tasks(CpuSpace, int count, const Work& work)
{
    CallersContext context;
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, count, work, context); });
}

/// Runs work(), which may itself run in parallel. The calling thread takes no outside work while it
/// waits, so work may use its thread-local memory.
template <typename Work>
void parallel_isolated(CpuSpace, const Work& work)
{
    tbb::this_task_arena::isolate(work);
}

/// Runs work(task, scratch) for task in [0, count): long tasks that need scratch memory. Each thread has one
/// scratch, made by make() at its first task. Counted as one call of stage `name`.
template <typename Make, typename Work>
void parallel_tasks_with(CpuSpace, std::string_view name, int count, const Make& make, const Work& work)
{
    const StageScope stage(name);
    tbb::enumerable_thread_specific<decltype(make())> scratch(make);
    parallel_tasks(kCpu, count, [&](int task) { work(task, scratch.local()); });
}

/// Sum of term(i) over [0, count): fixed blocks of kReductionBlock items, each summed in order, then the
/// block sums in order. Same bits for every thread count. T needs only +=, so vectors and matrices can be
/// summed too; an empty range gives `zero`.
template <typename T, typename Term>
T parallel_sum(CpuSpace, int count, const T& zero, const Term& term)
{
    constexpr int kReductionBlock = 2048;
    const int blocks = (count + kReductionBlock - 1) / kReductionBlock;
    const auto block_sum = [&](int block) {
        T sum = zero;
        const int end = std::min(count, (block + 1) * kReductionBlock);
        for (int i = block * kReductionBlock; i < end; ++i)
            sum += term(i);
        return sum;
    };
    if (blocks <= 1)
        return count > 0 ? block_sum(0) : zero;

    std::vector<T> sums(blocks, zero);
    CallersContext context;
    tbb::parallel_for(
        0, blocks, [&](int block) { sums[block] = block_sum(block); }, context);
    T total = zero;
    for (const T& sum : sums)
        total += sum;
    return total;
}

/// Runs find(begin, end, found) over [0, count) in fixed chunks and appends the chunks' results to `out` in
/// order: the same list for every thread count. Counted as one call of stage `name`.
template <typename T, typename Find>
void parallel_append(CpuSpace, std::string_view name, int count, const Find& find, std::vector<T>& out)
{
    constexpr int kChunk = 128;
    const StageScope stage(name);
    const int chunks = (count + kChunk - 1) / kChunk;
    std::vector<std::vector<T>> found(chunks);
    CallersContext context;
    tbb::parallel_for(
        0, chunks,
        [&](int chunk) { find(chunk * kChunk, std::min(count, (chunk + 1) * kChunk), found[chunk]); },
        context);
    for (const std::vector<T>& items : found)
        out.insert(out.end(), items.begin(), items.end());
}

} // namespace toile
