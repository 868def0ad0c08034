#pragma once

#include "core/compute/types.h"

namespace toile {

/// Copies a T of 8 or 16 bytes, aligned to its size, from global to shared memory of a block, asynchronously.
/// Writes zeros and reads nothing if `is_outside`. The copy is complete when parallel_tiles passes the stage
/// to the kernel. On the host it is immediate.
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

/// Waits until at most `Pending` of this thread's groups are in flight.
template <int Pending>
__device__ void wait_for_copies()
{
    asm volatile("cp.async.wait_group %0;" ::"n"(Pending) : "memory");
}

#endif

} // namespace toile
