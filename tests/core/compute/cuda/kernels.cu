#include "core/compute/cuda/gauss_seidel.cuh"
#include "tests/core/compute/cuda/kernels.h"

namespace toile::test {

using namespace garment;

void launch(const CudaSpace& space, const CountVisits& kernel, int block)
{
    parallel_for(space, "test/visit", kernel.visits.size(), kernel, block);
}

void launch(const CudaSpace& space, const CountEndVisits& kernel)
{
    parallel_for(space, "test/visit_ends", kernel.count, kernel);
}

void launch(const CudaSpace& space, const AddScaled& kernel)
{
    parallel_for(space, "test/add_scaled", kernel.sum.size(), kernel);
}

void launch(const CudaSpace& space, const ScaleBySlot& kernel)
{
    parallel_for(space, "test/scale", kernel.items.size(), kernel);
}

void launch(const CudaSpace& space, const AddLastTwo& kernel)
{
    parallel_for(space, "test/add_last_two", kernel.next.size(), kernel);
}

void launch(const CudaSpace& space, const SendNumbers& kernel)
{
    parallel_for(space, "test/send", 1, kernel);
}

void launch(const CudaSpace& space, const HearFromHost& kernel)
{
    parallel_for(space, "test/hear", 1, kernel);
}

void launch(const CudaSpace& space, const WriteWild& kernel)
{
    parallel_for(space, "test/wild", kernel.nowhere.size(), kernel);
}

void launch(const CudaSpace& space, const WriteLayout& kernel)
{
    parallel_for(space, "test/layout", 1, kernel);
}

void launch(const CudaSpace& space, const ProjectMembraneTriangle<Mat32>& kernel)
{
    parallel_for(space, "test/project", kernel.tri.size(), kernel);
}

void launch(const CudaSpace& space, const GatherCorners& kernel)
{
    parallel_for(space, "test/gather", kernel.gradient.size(), kernel);
}

void launch(const CudaSpace& space, const AssignGaussSeidelRank<SharedByItem, 2>& kernel)
{
    parallel_for(space, "test/assign_ranks", GaussSeidelState::kSharedSlots * kernel.state.order.count,
                 kernel);
}

void launch(const CudaSpace& space, const GaussSeidelState& state, int max_items, const MixShared& kernel)
{
    parallel_gauss_seidel(space, "test/mix", state, max_items, kernel);
}

void sum_into(const CudaSpace& space, View<const double> numbers, View<double> slot,
              DeviceArray<double>& block_sums)
{
    parallel_sum(space, "test/sum", numbers.size(), 0.0, NumberAt{numbers}, slot, block_sums);
}

double sum_of(const CudaSpace& space, View<const double> numbers, SumScratch<double>& scratch)
{
    return parallel_sum(space, "test/sum", numbers.size(), 0.0, NumberAt{numbers}, scratch);
}

Vec3 sum_of(const CudaSpace& space, const WeightedPoint& term, SumScratch<Vec3>& scratch)
{
    return parallel_sum(space, "test/vector_sum", term.weight.size(), Vec3(0.0, 0.0, 0.0), term, scratch);
}

} // namespace toile::test
