#include "core/compute/cuda/sort.h"

#include "core/compute/cuda/parallel.cuh"

#ifdef __CUDACC__
#include "core/compute/cuda/with_scratch.cuh"

#include <cub/device/device_radix_sort.cuh>
#endif

namespace toile {

void sort_by_key(const CudaSpace& space, std::string_view name, SortArrays& arrays,
                 [[maybe_unused]] View<int> sorted, [[maybe_unused]] int bits, CallSite where)
{
    const StageScope stage(name);
    if (arrays.values.size() == 0)
        return;
    const CudaLaunch launch(space, name, where);
#ifdef __CUDACC__
    with_scratch(arrays.scratch, [&](void* memory, std::size_t& bytes) {
        return cub::DeviceRadixSort::SortPairs(memory, bytes, arrays.keys.view().data(),
                                               arrays.sorted_keys.view().data(), arrays.values.view().data(),
                                               sorted.data(), arrays.values.size(), 0, bits, space.stream());
    });
#endif
    launch.done();
}

} // namespace toile
