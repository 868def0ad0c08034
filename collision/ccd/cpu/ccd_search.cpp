#include "collision/ccd/cpu/ccd_search.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

View<const BlockedPair> CpuCcdSearch::begin(View<const Vec3> x, View<const Vec3> end)
{
    motion_.resize(x.size());
    parallel_for(kCpu, "collision/motion", x.size(), DisplacementTo{x, end, motion_});
    near_.find(x, {motion_, slack_}, query_.gap().largest(), pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt_.is_exempt(pair); });
    query_.begin(x, end, slack_, pairs_);
    return query_.query_all(end);
}

} // namespace toile::collision
