#pragma once

/// Programmatic dependent launch: a kernel starts while the previous one still runs, so that its launch and
/// the loads of its prologue cost nothing. From Hopper on; elsewhere a kernel starts when the previous one
/// has ended. Graphs record it.
///
/// Used by parallel.cuh and its neighbours. Copies and sorts in a stream wait as usual.

#include "core/compute/cuda/runtime/device.h"

#ifdef __CUDACC__

#include <algorithm>
#include <iterator>
#include <type_traits>

namespace toile {

/// Waits until the previous launch is complete, then lets the next one start, which waits at the same point.
/// Every kernel calls this once.
__device__ inline void grid_dependency_wait()
{
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
    asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}

template <typename Kernel, typename... Item>
concept HasPrologue = requires(const Kernel& kernel, const Item&... item)
{
    kernel.prologue(item...);
};

/// Calls kernel(item...) after the previous launch is complete. If the kernel has prologue(item...), calls
/// that before the wait, and then kernel(item..., its result).
///
/// prologue() may load what the previous launch does not write, and writes nothing. All earlier launches of
/// the stream are complete. Writes of another stream are visible only after the wait.
template <typename Kernel, typename... Item>
__device__ void run_after_dependency(const Kernel& kernel, const Item&... item)
{
    if constexpr (HasPrologue<Kernel, Item...>) {
        const auto local = kernel.prologue(item...);
        grid_dependency_wait();
        kernel(item..., local);
    } else {
        grid_dependency_wait();
        kernel(item...);
    }
}

/// Whether kernels on this device were compiled with grid_dependency_wait(). That is so if the program has
/// code for exactly this kind of device, which is then chosen.
inline bool has_dependent_launch(const CudaDevice& device)
{
    constexpr int kCompiledFor[] = {__CUDA_ARCH_LIST__};
    const int kind = 100 * device.capability_major + 10 * device.capability_minor;
    return kind >= 900 && std::ranges::find(kCompiledFor, kind) != std::end(kCompiledFor);
}

/// Launches a kernel that calls grid_dependency_wait(). CudaLaunch::done() sees a refusal.
template <typename... Parameters>
void launch_kernel(const CudaSpace& space, void (*kernel)(Parameters...), int blocks, int threads,
                   std::size_t shared_bytes, const std::type_identity_t<Parameters>&... parameters)
{
    cudaLaunchAttribute dependent_launch{};
    dependent_launch.id = cudaLaunchAttributeProgrammaticStreamSerialization;
    dependent_launch.val.programmaticStreamSerializationAllowed = 1;
    cudaLaunchConfig_t config{};
    config.gridDim = dim3(unsigned(blocks));
    config.blockDim = dim3(unsigned(threads));
    config.dynamicSmemBytes = shared_bytes;
    config.stream = space.stream();
    config.attrs = &dependent_launch;
    config.numAttrs = has_dependent_launch(space.device()) ? 1 : 0;
    static_cast<void>(cudaLaunchKernelEx(&config, kernel, parameters...));
}

} // namespace toile

#endif
