#include "core/backend/cuda/scan.h"

#ifdef __CUDACC__
#include <cub/device/device_scan.cuh>
#endif

#include "core/backend/cuda/parallel.cuh"

namespace toile {

namespace {

/// CUB's two calls: with no scratch it only says how many bytes it needs.
cuda::Status scan([[maybe_unused]] void* scratch, [[maybe_unused]] std::size_t& bytes,
                  [[maybe_unused]] View<const int> numbers, [[maybe_unused]] View<int> sums,
                  [[maybe_unused]] CUstream_st* stream)
{
#ifdef __CUDACC__
    return cuda::Status(int(
        cub::DeviceScan::ExclusiveSum(scratch, bytes, numbers.data(), sums.data(), numbers.size(), stream)));
#else
    return cuda::Status::NotBuilt;
#endif
}

} // namespace

void exclusive_sums(const CudaSpace& space, std::string_view name, View<const int> numbers, View<int> sums,
                    DeviceArray<unsigned char>& scratch, CallSite where)
{
    TOILE_ASSERT(numbers.size() == sums.size());
    const StageScope stage(name);
    if (numbers.empty())
        return;
    const CudaLaunch launch(space, name, where);
    std::size_t bytes = 0;
    launch.require(scan(nullptr, bytes, numbers, sums, space.stream()));
    if (std::size_t(scratch.size()) < bytes)
        scratch.resize(int(bytes));
    launch.require(scan(scratch.view().data(), bytes, numbers, sums, space.stream()));
    launch.done();
}

} // namespace toile
