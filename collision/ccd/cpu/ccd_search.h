#pragma once

#include <vector>

#include "collision/ccd/cpu/ccd_query.h"

namespace toile::collision {

/// CcdSearch on the CPU.
class CpuCcdSearch : public CcdSearch {
public:
    /// @param near, exempt  see CpuCcdQuery; borrowed
    /// @param slack         [vertices] distance from the end that the pairs cover [m]; borrowed
    CpuCcdSearch(NearPairs& near, const ExemptPairs& exempt, const MinGap& gap, View<const double> slack)
        : near_(near), exempt_(exempt), slack_(slack), query_(near, exempt, gap)
    {
    }

    View<const BlockedPair> begin(View<const Vec3> x, View<const Vec3> end) override;
    View<const BlockedPair> query_all(View<const Vec3> end) override { return query_.query_all(end); }
    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override
    {
        return query_.update(changed);
    }

private:
    NearPairs& near_;
    const ExemptPairs& exempt_;
    View<const double> slack_;
    CpuCcdQuery query_;
    std::vector<Vec3> motion_; ///< [vertices] [m]
    std::vector<NearPair> pairs_;
};

} // namespace toile::collision
