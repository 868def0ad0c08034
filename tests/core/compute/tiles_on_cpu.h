#pragma once

#include <vector>

#include "core/compute/parallel.h"

namespace toile::test {

/// parallel_tiles on the CPU: the threads of a block run one after the other.
template <typename Kernel>
void parallel_tiles(CpuSpace, int count, const Kernel& kernel)
{
    for (int tile = 0; tile < count; ++tile) {
        std::vector<typename Kernel::Sums> sums(Kernel::kThreads, typename Kernel::Sums{});
        typename Kernel::Stage stage;
        for (int step = 0; step < kernel.work(tile, 0).steps(); ++step) {
            for (int thread = 0; thread < Kernel::kThreads; ++thread)
                kernel.work(tile, thread).load(step, stage);
            for (int thread = 0; thread < Kernel::kThreads; ++thread)
                kernel.work(tile, thread).add(stage, sums[thread]);
        }
        for (int thread = 0; thread < Kernel::kThreads; ++thread)
            kernel.work(tile, thread).store(sums[thread]);
    }
}

} // namespace toile::test
