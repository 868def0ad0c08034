#include "avatars/lid_kernels.h"
#include "avatars/skinning_kernels.h"
#include "core/backend/cuda/parallel.cuh"

namespace toile {

void launch(const CudaSpace& space, const SkinVertices& kernel)
{
    parallel_for(space, "avatars/device_skin", kernel.x.size(), kernel);
}

void launch(const CudaSpace& space, const PlaceLids& kernel)
{
    parallel_for(space, "avatars/device_lids", kernel.middles.size(), kernel);
}

} // namespace toile
