#pragma once

/// How kernels are handed to a stream: early. A kernel comes onto the device while the one before it still
/// runs, so that its launch, and what it loads before its turn, cost nothing (programmatic dependent launch,
/// from Hopper on; elsewhere kernels begin when the one before has ended). Graphs record it.
///
/// Used by parallel.cuh and its neighbours. All else that a stream is given, copies and sorts, waits as ever.

#include "core/backend/cuda/device.h"

#ifdef __CUDACC__

#include <algorithm>
#include <iterator>
#include <type_traits>

namespace toile {

/// Every kernel does this once: waits until the launch before it is done, all of it, and then lets the one
/// behind come, which will wait in the same place.
__device__ inline void wait_for_turn()
{
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
    asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}

template <typename Kernel, typename... Item>
concept LoadsEarly = requires(const Kernel& kernel, const Item&... item)
{
    kernel.early(item...);
};

/// Calls kernel(item...) in turn; where the kernel has early(item...), calls that before its turn and then
/// kernel(item..., what came of it).
///
/// early() may load what the launch directly before does not write, and writes nothing: all launches before
/// that one of the same stream are done. What another stream writes is there after the turn only.
template <typename Kernel, typename... Item>
__device__ void run_in_turn(const Kernel& kernel, const Item&... item)
{
    if constexpr (LoadsEarly<Kernel, Item...>) {
        const auto own = kernel.early(item...);
        wait_for_turn();
        kernel(item..., own);
    } else {
        wait_for_turn();
        kernel(item...);
    }
}

/// Whether what runs on this device was compiled with wait_for_turn(): code for just this kind is then in
/// the program, and no other is chosen.
inline bool comes_early(const CudaDevice& device)
{
    constexpr int kCompiledFor[] = {__CUDA_ARCH_LIST__};
    const int kind = 100 * device.capability_major + 10 * device.capability_minor;
    return kind >= 900 && std::ranges::find(kCompiledFor, kind) != std::end(kCompiledFor);
}

/// Launches a kernel that calls wait_for_turn(). What is refused is seen by CudaLaunch::done().
template <typename... Parameters>
void launch_kernel(const CudaSpace& space, void (*kernel)(Parameters...), int blocks, int threads,
                   std::size_t shared_bytes, const std::type_identity_t<Parameters>&... parameters)
{
    cudaLaunchAttribute early{};
    early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    early.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(unsigned(blocks));
    config.blockDim = dim3(unsigned(threads));
    config.dynamicSmemBytes = shared_bytes;
    config.stream = space.stream();
    config.attrs = &early;
    config.numAttrs = comes_early(space.device()) ? 1 : 0;
    static_cast<void>(cudaLaunchKernelEx(&config, kernel, parameters...));
}

} // namespace toile

#endif
