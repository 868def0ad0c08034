#include "core/compute/cuda/scan.h"

#include "core/compute/cuda/grown_array.h"
#include "core/compute/cuda/parallel.cuh"

#ifdef __CUDACC__
#include "core/compute/cuda/with_scratch.cuh"

#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <thrust/iterator/counting_iterator.h>
#endif

namespace toile {

void exclusive_scan(const CudaSpace& space, std::string_view name, View<const int> counts,
                    [[maybe_unused]] View<long> first, [[maybe_unused]] DeviceScratch& scratch,
                    CallSite where)
{
    const StageScope stage(name);
    if (counts.empty())
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    with_scratch(scratch, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceScan::ExclusiveScan(memory, bytes, counts.data(), first.data(),
                                              ::cuda::std::plus<>(), 0L, counts.size(), space.stream());
    });
#endif
    launch.done();
}

void list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                  [[maybe_unused]] View<int> indices, [[maybe_unused]] View<int> count,
                  [[maybe_unused]] DeviceScratch& scratch, CallSite where)
{
    const StageScope stage(name);
    if (flags.empty())
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    with_scratch(scratch, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceSelect::Flagged(memory, bytes, thrust::counting_iterator<int>(0), flags.data(),
                                          indices.data(), count.data(), flags.size(), space.stream());
    });
#endif
    launch.done();
}

int list_flagged(const CudaSpace& space, std::string_view name, View<const unsigned char> flags,
                 DeviceArray<int>& indices, PinnedArray<int>& count, DeviceScratch& scratch, CallSite where)
{
    if (flags.empty())
        return 0;
    list_flagged(space, name, flags, first_items(indices, flags.size()), count.view(), scratch, where);
    space.synchronise(where);
    return count[0];
}

} // namespace toile
