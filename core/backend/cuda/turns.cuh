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

/// Shortest time from one turn to the next at the same thing [ns]: who rests for longer sleeps through its
/// turn, and who rests for less only asks more often.
inline constexpr unsigned kShortestTurn = 300;

/// The word as a whole, however many others read and write it: one access to a number of 128 bits, where a
/// vector of two numbers would be two (PTX ISA 8.3, "memory consistency model").
__device__ inline TaggedVector::Word load_word(const TaggedVector::Word& word)
{
    TaggedVector::Word loaded;
    asm volatile("{ .reg .b128 whole; ld.relaxed.gpu.global.b128 whole, [%2]; mov.b128 {%0, %1}, whole; }"
                 : "=l"(loaded.number), "=l"(loaded.part_and_turns)
                 : "l"(&word)
                 : "memory");
    return loaded;
}
/// The same to write it.
__device__ inline void store_word(TaggedVector::Word& word, const TaggedVector::Word& stored)
{
    asm volatile(
        "{ .reg .b128 whole; mov.b128 whole, {%1, %2}; st.relaxed.gpu.global.b128 [%0], whole; }" ::"l"(
            &word),
        "l"(stored.number), "l"(stored.part_and_turns)
        : "memory");
}

/// An item's turn.
template <int kFields>
class Turn {
public:
    /// @param shared  what the item shares; -1 unused
    __device__ Turn(const Turns& turns, int item, const std::array<int, Turns::kShares>& shared,
                    const SharedFields<kFields>& fields)
        : passed_(turns.passed.data()), fields_(fields), shared_(shared)
    {
        for (int k = 0; k < Turns::kShares; ++k)
            if (shared[k] >= 0)
                rank_[k] = turns.rank[Turns::kShares * item + k];
    }

    /// Until all before it have had theirs. @param own  out
    __device__ void await(OwnFields<kFields>& own) const
    {
        for (int left = look(own); left > 0; left = look(own))
            if (left > 1)
                __nanosleep(unsigned(left - 1) * kShortestTurn);
    }

    __device__ void pass_on(const OwnFields<kFields>& own) const
    {
        for_each_shared([&](int f, int k) {
            if (rank_[k].is_last()) {
                fields_[f][shared_[k]] = own[f][k];
                return;
            }
            const TaggedVector left(own[f][k], rank_[k].before() + 1);
            store_word(at(f, k).words[0], left.words[0]);
            store_word(at(f, k).words[1], left.words[1]);
        });
    }

private:
    /// Asks for all that it shares at once. @return how many turns it waits for at least
    __device__ int look(OwnFields<kFields>& own) const
    {
        int left = 0;
        for_each_shared([&](int f, int k) {
            TaggedVector passed;
            passed.words[0] = load_word(at(f, k).words[0]);
            passed.words[1] = load_word(at(f, k).words[1]);
            own[f][k] = passed.value();
            left = max(left, rank_[k].before() - passed.turns());
        });
        return left;
    }

    /// Calls act(f, k) for field f of the k-th that it shares.
    template <typename Act>
    __device__ void for_each_shared(const Act& act) const
    {
#pragma unroll
        for (int f = 0; f < kFields; ++f)
#pragma unroll
            for (int k = 0; k < Turns::kShares; ++k)
                if (shared_[k] >= 0)
                    act(f, k);
    }
    __device__ TaggedVector& at(int f, int k) const { return passed_[f * fields_[f].size() + shared_[k]]; }

    TaggedVector* passed_;
    SharedFields<kFields> fields_;
    std::array<int, Turns::kShares> shared_;
    std::array<TurnRank, Turns::kShares> rank_;
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
        const auto prepared = kernel.prepare(item);
        const Turn<Kernel::kFields> turn(turns, item, kernel.shared(prepared), kernel.fields());
        OwnFields<Kernel::kFields> own;
        turn.await(own);
        kernel(item, prepared, own);
        turn.pass_on(own);
    }
}

#endif

/// Launches kernel(item, kernel.prepare(item), own) for all listed items in the stream's turn and returns.
/// Each begins when those before it that share something with it are done, so that the result is that of one
/// after the other. prepare() loads what no item changes, and kernel.shared() tells by that what the item
/// shares with others. `own` has the vectors of that in each of kernel.fields(), to read and to change;
/// nothing else that one item changes is seen by another. Counted and refused as parallel_for.
/// @param turns  numbered (NumberTurn) with the same fields; next[0] is 0
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
