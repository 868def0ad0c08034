#include "core/backend/cuda/parallel.cuh"
#include "garment/energy/membrane_kernels.h"

namespace toile {

void launch(const CudaSpace& space, const ProjectMembraneTriangle& kernel)
{
    parallel_for(space, "membrane/project", kernel.tri.size(), kernel);
}

void launch(const CudaSpace& space, const GatherCorners& kernel)
{
    parallel_for(space, "membrane/gather", kernel.gradient.size(), kernel);
}

} // namespace toile
