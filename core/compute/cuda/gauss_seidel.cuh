#pragma once

/// Launches on a GPU in which items that share data run one after the other. Included by .cu files, as
/// parallel.cuh.

#include <algorithm>
#include <string_view>

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/gauss_seidel.h"

namespace toile {

/// Max number of threads that visit items: no device runs more at once, and more would only wait.
inline constexpr int kVisitors = 8448;

#ifdef __CUDACC__

/// Min time between two successive visits of a shared datum [ns]. A longer sleep would overshoot the wait; a
/// shorter one only polls more often.
inline constexpr unsigned kMinVisitTime = 300;

/// Loads a word atomically, as one access to a number of 128 bits. A vector of two numbers would be two
/// accesses (PTX ISA 8.3, "memory consistency model").
__device__ inline TaggedVector::Word load_word(const TaggedVector::Word& word)
{
    TaggedVector::Word loaded;
    asm volatile("{ .reg .b128 whole; ld.relaxed.gpu.global.b128 whole, [%2]; mov.b128 {%0, %1}, whole; }"
                 : "=l"(loaded.number), "=l"(loaded.part_and_version)
                 : "l"(&word)
                 : "memory");
    return loaded;
}
/// Stores a word atomically, as load_word() loads it.
__device__ inline void store_word(TaggedVector::Word& word, const TaggedVector::Word& stored)
{
    asm volatile(
        "{ .reg .b128 whole; mov.b128 whole, {%1, %2}; st.relaxed.gpu.global.b128 [%0], whole; }" ::"l"(
            &word),
        "l"(stored.number), "l"(stored.part_and_version)
        : "memory");
}

/// Tickets of an item for the data that it shares, as in a ticket lock.
template <int kFields>
class GaussSeidelTicket {
public:
    /// @param shared  shared data of the item; -1 unused
    __device__ GaussSeidelTicket(const GaussSeidelState& state, int item,
                                 const std::array<int, GaussSeidelState::kSharedSlots>& shared,
                                 const SharedFields<kFields>& fields)
        : passed_(state.passed.data()), fields_(fields), shared_(shared)
    {
        for (int k = 0; k < GaussSeidelState::kSharedSlots; ++k)
            if (shared[k] >= 0)
                rank_[k] = state.rank[GaussSeidelState::kSharedSlots * item + k];
    }

    /// Waits until all items before this one have passed on the data.
    /// @param local  out
    __device__ void await(LocalFields<kFields>& local) const
    {
        for (int left = poll(local); left > 0; left = poll(local))
            if (left > 1)
                __nanosleep(unsigned(left - 1) * kMinVisitTime);
    }

    __device__ void pass_on(const LocalFields<kFields>& local) const
    {
        for_each_shared([&](int f, int k) {
            if (rank_[k].is_last()) {
                fields_[f][shared_[k]] = local[f][k];
                return;
            }
            const TaggedVector left(local[f][k], rank_[k].before() + 1);
            store_word(at(f, k).words[0], left.words[0]);
            store_word(at(f, k).words[1], left.words[1]);
        });
    }

private:
    /// Polls all shared data at once.
    /// @return lower bound of the number of visits still to wait for
    __device__ int poll(LocalFields<kFields>& local) const
    {
        int left = 0;
        for_each_shared([&](int f, int k) {
            TaggedVector passed;
            passed.words[0] = load_word(at(f, k).words[0]);
            passed.words[1] = load_word(at(f, k).words[1]);
            local[f][k] = passed.value();
            left = max(left, rank_[k].before() - passed.version());
        });
        return left;
    }

    /// Calls visit(f, k) for field f of the k-th shared datum.
    template <typename Visit>
    __device__ void for_each_shared(const Visit& visit) const
    {
#pragma unroll
        for (int f = 0; f < kFields; ++f)
#pragma unroll
            for (int k = 0; k < GaussSeidelState::kSharedSlots; ++k)
                if (shared_[k] >= 0)
                    visit(f, k);
    }
    __device__ TaggedVector& at(int f, int k) const { return passed_[f * fields_[f].size() + shared_[k]]; }

    TaggedVector* passed_;
    SharedFields<kFields> fields_;
    std::array<int, GaussSeidelState::kSharedSlots> shared_;
    std::array<GaussSeidelRank, GaussSeidelState::kSharedSlots> rank_;
};

/// Visits items in order. An item waits only for visits that have begun, and the first of these never waits,
/// so any number of running threads makes progress. Only one thread of a warp works: while it waits, its
/// warp waits.
template <typename Kernel>
__global__ void run_gauss_seidel(const GaussSeidelState state, const Kernel kernel)
{
    grid_dependency_wait();
    if (threadIdx.x % kWarp != 0)
        return;
    const unsigned count = unsigned(state.count[0]);
    unsigned* const next = state.next.data();
    for (unsigned visit = atomicAdd(next, 1U); visit < count; visit = atomicAdd(next, 1U)) {
        const int item = state.order.at(state.slots[int(visit)]);
        const auto prepared = kernel.prepare(item);
        const GaussSeidelTicket<Kernel::kFields> ticket(state, item, kernel.shared(prepared),
                                                        kernel.fields());
        LocalFields<Kernel::kFields> local;
        ticket.await(local);
        kernel(item, prepared, local);
        ticket.pass_on(local);
    }
}

#endif

/// Launches kernel(item, kernel.prepare(item), local) for all listed items in stream order and returns. An
/// item begins when the items before it that share data with it are done, so the result is that of a
/// sequential sweep. Counts and throws as parallel_for.
///
/// prepare() loads only what no item changes; kernel.shared() derives the item's shared data from its result.
/// `local` holds their vectors in each of kernel.fields(), to read and to change. No other change by an item
/// is visible to other items.
/// @param state      initialised by AssignGaussSeidelRank with the same fields; next[0] is 0
/// @param max_items  max number of listed items
template <typename Kernel>
void parallel_gauss_seidel(const CudaSpace& space, std::string_view name,
                           [[maybe_unused]] const GaussSeidelState& state, int max_items,
                           [[maybe_unused]] const Kernel& kernel, CallSite where = CallSite::here())
{
    const StageScope stage(name);
    if (max_items <= 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    constexpr int kBlock = 128;
    launch_kernel(space, run_gauss_seidel<Kernel>,
                  block_count(std::min(max_items, kVisitors), kBlock / kWarp), kBlock, 0, state, kernel);
#endif
    launch.done();
}

} // namespace toile
