#include "avatars/model/lid_kernels.h"
#include "avatars/model/skinning_kernels.h"
#include "core/compute/cuda/parallel.cuh"

namespace toile::avatars {

void launch(const CudaSpace& space, const SkinVertices& kernel)
{
    parallel_for(space, "avatars/device_skin", kernel.x.size(), kernel);
}

void launch(const CudaSpace& space, const PlaceLids& kernel)
{
    parallel_for(space, "avatars/device_lids", kernel.middles.size(), kernel);
}

} // namespace toile::avatars
