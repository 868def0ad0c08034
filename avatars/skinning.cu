#include "avatars/skinning_kernels.h"
#include "core/backend/cuda/parallel.cuh"

namespace toile {

void launch(const CudaSpace& space, const SkinVertices& kernel)
{
    parallel_for(space, "avatars/skin", kernel.x.size(), kernel);
}

void launch(const CudaSpace& space, const PlaceVertices& kernel)
{
    parallel_for(space, "avatars/place", kernel.x.size(), kernel);
}

} // namespace toile
