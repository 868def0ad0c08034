#pragma once

#include "core/backend/cuda/report.h"
#include "core/backend/cuda/team.h"

namespace toile {

/// What a sum that is read back (parallel.cuh) needs; kept between sums so that none asks for memory.
template <typename T>
struct SumScratch {
    explicit SumScratch(const CudaSpace& space) : block_sums(space, "sum/blocks"), total(space, "sum/total")
    {
    }

    DeviceArray<T> block_sums;
    DeviceReport<T> total;
};

/// Threads of a block of a record's sum, and blocks at most: one for every multiprocessor of a large device,
/// with many registers. They decide how it rounds, whatever the device.
inline constexpr int kRecordThreads = 384;
inline constexpr int kRecordBlocks = 132;

/// What the sum of a record (record_sum.cuh) needs.
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
