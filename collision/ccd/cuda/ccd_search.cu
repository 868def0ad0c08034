#include "collision/ccd/cuda/ccd_search.h"

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/parallel.h"

namespace toile::collision {

DeviceCcdSearch::DeviceCcdSearch(const CudaSpace& space, AsyncNearPairs& near, DeviceCollisionFreeStep& query,
                                 const MinGap& gap, const DeviceArray<double>& slack)
    : space_(space), near_(near), query_(query), margin_(gap.largest()), slack_(slack),
      x_(space, "ccd_search/x"), end_(space, "ccd_search/end"), motion_(space, "ccd_search/motion"),
      host_end_(space, "ccd_search/host_end")
{
}

View<const BlockedPair> DeviceCcdSearch::begin(View<const Vec3> x, View<const Vec3> end)
{
    x_.upload(x);
    send_end(end);
    motion_.resize(x.size());
    parallel_for(space_, "collision/motion", x.size(),
                 DisplacementTo{x_.view(), end_.view(), motion_.view()});
    near_.begin(x_.view(), {motion_.view(), slack_.view()}, margin_);
    query_.begin(x_.view(), end_.view(), slack_.view(), near_.end());
    return query_.query_all(end_.view());
}

View<const BlockedPair> DeviceCcdSearch::query_all(View<const Vec3> end)
{
    send_end(end);
    return query_.query_all(end_.view());
}

void DeviceCcdSearch::send_end(View<const Vec3> end)
{
    host_end_.resize(end.size());
    const View<Vec3> sent = host_end_.view();
    parallel_for(kCpu, "collision/send", end.size(), [&](int v) { sent[v] = end[v]; });
    end_.upload(sent);
}

} // namespace toile::collision
