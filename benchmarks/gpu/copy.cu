#include "benchmarks/gpu/copy.h"

#include "core/backend/cuda/parallel.cuh"

namespace toile::gpu {

void launch(const CudaSpace& space, const CopyItems& kernel)
{
    parallel_for(space, "benchmarks/copy", kernel.to.size(), kernel);
}

} // namespace toile::gpu
