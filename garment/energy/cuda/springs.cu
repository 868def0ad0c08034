#include "garment/energy/cuda/springs.h"

#include <algorithm>
#include <numeric>

#include "core/compute/cuda/parallel.cuh"

namespace toile::garment {

DeviceSprings::DeviceSprings(const CudaSpace& space)
    : space_(space), anchors_(space, "springs/anchors"), first_(space, "springs/first")
{
}

void DeviceSprings::add(const Springs& springs, int first_vertex)
{
    parts_.push_back({&springs, first_vertex});
    std::vector<int> vertices;
    for (const Part& part : parts_)
        for (const AnchorSpring& spring : part.springs->anchors())
            vertices.push_back(part.first_vertex + spring.vertex);
    std::vector<int> sorted(vertices.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return vertices[a] < vertices[b]; });

    order_.resize(sorted.size());
    std::vector<int> first;
    for (int k = 0; k < int(sorted.size()); ++k) {
        order_[sorted[k]] = k;
        if (k == 0 || vertices[sorted[k]] != vertices[sorted[k - 1]])
            first.push_back(k);
    }
    first.push_back(int(sorted.size()));
    first_.upload(first);
    host_.resize(sorted.size());
    take_springs();
}

void DeviceSprings::begin_step(View<const Vec3>, double) { take_springs(); }

void DeviceSprings::take_springs()
{
    int k = 0;
    for (const Part& part : parts_)
        for (const AnchorSpring& spring : part.springs->anchors()) {
            AnchorSpring& copy = host_[order_[k++]];
            copy = spring;
            copy.vertex += part.first_vertex;
        }
    anchors_.upload(host_);
}

void DeviceSprings::add_gradient(const DeviceEvaluation& at)
{
    parallel_for(space_, "springs/pull", first_.size() - 1,
                 PullAnchoredVertex{anchors_.view(), first_.view(), at.x, at.gradient, at.energy});
}

void DeviceSprings::add_curvature(const DeviceCurvature& at)
{
    parallel_for(space_, "springs/curvature", first_.size() - 1,
                 StiffenAnchoredVertex{anchors_.view(), first_.view(), at.sum});
}

} // namespace toile::garment
