#pragma once

#include "collision/ccd/cuda/collision_free_step.h"

namespace toile::collision {

/// CcdSearch on a GPU, with the search and the pairs of a DeviceCollisionFreeStep between two of its steps.
class DeviceCcdSearch : public CcdSearch {
public:
    /// @param space        borrowed
    /// @param near, query  of the same vertices; borrowed
    /// @param gap          of the query's pairs
    /// @param slack        [vertices] distance from the end that the pairs cover, on the device [m]; borrowed
    DeviceCcdSearch(const CudaSpace& space, AsyncNearPairs& near, DeviceCollisionFreeStep& query,
                    const MinGap& gap, const DeviceArray<double>& slack);

    View<const BlockedPair> begin(View<const Vec3> x, View<const Vec3> end) override;
    View<const BlockedPair> query_all(View<const Vec3> end) override;
    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override
    {
        return query_.update(changed);
    }

private:
    void send_end(View<const Vec3> end);

    const CudaSpace& space_;
    AsyncNearPairs& near_;
    DeviceCollisionFreeStep& query_;
    double margin_; ///< [m]
    const DeviceArray<double>& slack_;
    DeviceArray<Vec3> x_, end_, motion_; ///< [vertices] [m]
    PinnedArray<Vec3> host_end_;         ///< staging of end_
};

} // namespace toile::collision
