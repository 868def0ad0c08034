#include "core/pd/cuda/newton/hessian.h"

#include "core/compute/cuda/parallel.cuh"

namespace toile {

DeviceHessian::DeviceHessian(const CudaSpace& space, const HessianPattern& pattern, DeviceEnergies& energies)
    : space_(space), energies_(energies), first_block_(space, "hessian/first_block"),
      block_columns_(space, "hessian/block_columns"), first_scalar_(space, "hessian/first_scalar"),
      scalar_columns_(space, "hessian/scalar_columns"),
      first_part_(space, "hessian/first_part", pattern.blocks().size()),
      second_part_(space, "hessian/second_part", pattern.blocks().size()),
      last_part_(space, "hessian/last_part", pattern.blocks().size()), constant_(space, "hessian/constant"),
      scalars_(space, "hessian/scalars", pattern.scalars().size()), sum_(space, "hessian/sum")
{
    first_block_.upload(pattern.blocks().first());
    block_columns_.upload(pattern.blocks().columns());
    first_scalar_.upload(pattern.scalars().first());
    scalar_columns_.upload(pattern.scalars().columns());
    constant_.upload(pattern.constant_scalars());
    for (const auto& energy : energies_.all())
        energy->find_entries(pattern);
}

HessianBlocks DeviceHessian::blocks() { return {first_part_.view(), second_part_.view(), last_part_.view()}; }

void DeviceHessian::linearise(View<const Vec3> x, View<const double> inertia)
{
    const StageScope stage("newton/hessian");
    sum_.resize(inertia.size());
    parallel_for(space_, "hessian/begin_sum", inertia.size(), BeginSum{inertia, sum_.view()});
    parallel_for(space_, "hessian/begin_scalars", scalars_.size(),
                 BeginScalars{constant_.view(), scalars_.view()});
    first_part_.fill_zero();
    second_part_.fill_zero();
    last_part_.fill_zero();
    for (const auto& energy : energies_.all())
        energy->add_curvature({x, blocks(), scalars_.view(), sum_.view()});
}

SlicedHessian DeviceHessian::view()
{
    return {first_block_.view(),    block_columns_.view(), blocks(),   first_scalar_.view(),
            scalar_columns_.view(), scalars_.view(),       sum_.view()};
}

} // namespace toile
