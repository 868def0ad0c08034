#pragma once

#include "core/backend/cuda/array.h"

namespace toile {

/// What a sum that is read back (parallel.cuh) needs; kept between sums so that none asks for memory.
template <typename T>
struct SumScratch {
    explicit SumScratch(const CudaSpace& space)
        : block_sums(space, "sum/blocks"), total(space, "sum/total", 1), value(space, "sum/value", 1)
    {
    }

    DeviceArray<T> block_sums;
    DeviceArray<T> total;
    PinnedArray<T> value;
};

} // namespace toile
