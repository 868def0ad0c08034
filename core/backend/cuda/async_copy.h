#pragma once

#include "core/backend/types.h"

#ifdef __CUDACC__
#include <cuda_pipeline.h>
#endif

namespace toile {

/// Copies T, of 8 or 16 bytes and aligned to them, from a device's memory to the memory that a block of
/// threads shares, beside what the thread goes on to do; writes zeros where it `is_outside`, and then reads
/// nothing. Done when parallel_tiles hands the stage out. On the host it copies at once.
template <typename T>
TOILE_HD void copy_async(T* to, const T* from, bool is_outside)
{
    static_assert(sizeof(T) == 8 || sizeof(T) == 16);
#ifdef __CUDA_ARCH__
    __pipeline_memcpy_async(to, from, sizeof(T), is_outside ? sizeof(T) : 0);
#else
    *to = is_outside ? T{} : *from;
#endif
}

} // namespace toile
