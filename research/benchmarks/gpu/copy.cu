#include "research/benchmarks/gpu/copy.h"

#include "core/compute/cuda/parallel.cuh"

namespace toile::research::gpu {

void launch(const CudaSpace& space, const CopyItems& kernel)
{
    parallel_for(space, "benchmarks/copy", kernel.to.size(), kernel);
}

} // namespace toile::research::gpu
