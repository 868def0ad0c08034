#pragma once

/// Calls of CUB, which are made twice: to query the memory that they need, and to run.

#include <cuda_runtime_api.h>

#include "core/compute/cuda/scan.h"

namespace toile {

/// Resizes `scratch` as needed and makes the call.
/// @param call  (void* memory, size_t& bytes) -> cudaError_t; a refused launch is left to CudaLaunch::done()
template <typename Call>
void with_scratch(DeviceScratch& scratch, const Call& call)
{
    std::size_t bytes = 0;
    if (call(nullptr, bytes) != cudaSuccess)
        return;
    if (std::size_t(scratch.size()) < bytes)
        scratch.resize(int(bytes));
    static_cast<void>(call(static_cast<void*>(scratch.view().data()), bytes));
}

} // namespace toile
