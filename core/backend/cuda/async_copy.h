#pragma once

#include "core/backend/types.h"

namespace toile {

/// Copies T, of 8 or 16 bytes and aligned to them, from a device's memory to the memory that a block of
/// threads shares, beside what the thread goes on to do; writes zeros where it `is_outside`, and then reads
/// nothing. Done when parallel_tiles hands the stage out. On the host it copies at once.
template <typename T>
TOILE_HD void copy_async(T* to, const T* from, bool is_outside)
{
    static_assert(sizeof(T) == 8 || sizeof(T) == 16);
#ifdef __CUDA_ARCH__
    const auto shared = unsigned(__cvta_generic_to_shared(to));
    asm volatile("cp.async.ca.shared.global [%0], [%1], %2, %3;" ::"r"(shared), "l"(from), "n"(sizeof(T)),
                 "r"(is_outside ? 0U : unsigned(sizeof(T)))
                 : "memory");
#else
    *to = is_outside ? T{} : *from;
#endif
}

#ifdef __CUDACC__

/// Closes a group of this thread's copies, which may be empty.
__device__ inline void commit_copies() { asm volatile("cp.async.commit_group;" ::: "memory"); }

/// Waits until at most `Pending` of this thread's groups are still on their way.
template <int Pending>
__device__ void wait_for_copies()
{
    asm volatile("cp.async.wait_group %0;" ::"n"(Pending) : "memory");
}

#endif

} // namespace toile
