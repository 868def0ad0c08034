#pragma once

#include "core/compute/cuda/report.h"
#include "core/compute/team.h"

namespace toile {

/// Memory of a sum that is read back (parallel.cuh); kept so that later sums allocate nothing.
template <typename T>
struct SumScratch {
    explicit SumScratch(const CudaSpace& space) : block_sums(space, "sum/blocks"), total(space, "sum/total")
    {
    }

    DeviceArray<T> block_sums;
    DeviceReport<T> total;
};

/// Threads of a block in the sum of a record, and max number of blocks: one for every multiprocessor of a
/// large device, with many registers. They decide how it rounds, on every device alike.
inline constexpr int kRecordThreads = 384;
inline constexpr int kRecordBlocks = 132;

/// Memory of the sum of a record (record_sum.cuh).
struct RecordScratch {
    explicit RecordScratch(const CudaSpace& space)
        : block_sums(space, "sum/record_blocks", kRecordBlocks * kWarp), finished(space, "sum/finished", 1)
    {
        finished.fill_zero();
    }

    DeviceArray<double> block_sums;
    DeviceArray<unsigned> finished;
};

} // namespace toile
