#pragma once

#include <tbb/task_arena.h>

#include "core/compute/parallel.h"

namespace toile {

/// Runs work() on the calling thread and on up to `threads` - 1 others. The others help only while no work of
/// ordinary priority needs them.
template <typename Work>
void with_low_priority(CpuSpace, int threads, const Work& work)
{
    tbb::task_arena arena(threads, 1, tbb::task_arena::priority::low);
    arena.execute(work);
}

} // namespace toile
