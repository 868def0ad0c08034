#include "garment/energy/device_springs.h"

#include <algorithm>

#include "core/backend/cuda/parallel.cuh"

namespace toile {

DeviceSprings::DeviceSprings(const CudaSpace& space)
    : space_(space), placed_(space, "springs/placed"), first_(space, "springs/first")
{
}

void DeviceSprings::add(const Springs& springs, int first_vertex)
{
    parts_.push_back({&springs, first_vertex});
    begin_step();
    std::vector<int> first;
    for (int j = 0; j < int(host_.size()); ++j)
        if (j == 0 || host_[j].vertex != host_[j - 1].vertex)
            first.push_back(j);
    first.push_back(int(host_.size()));
    first_.upload(first);
}

void DeviceSprings::begin_step()
{
    host_.clear();
    for (const Part& part : parts_)
        for (PlacedSpring spring : part.springs->placed()) {
            spring.vertex += part.first_vertex;
            host_.push_back(spring);
        }
    std::stable_sort(host_.begin(), host_.end(),
                     [](const PlacedSpring& a, const PlacedSpring& b) { return a.vertex < b.vertex; });
    placed_.upload(host_);
}

void DeviceSprings::add_gradient(const DeviceEvaluation& at)
{
    parallel_for(space_, "springs/pull", first_.size() - 1,
                 PullHeldVertex{placed_.view(), first_.view(), at.x, at.gradient, at.energy});
}

} // namespace toile
