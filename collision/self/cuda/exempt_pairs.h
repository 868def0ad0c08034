#pragma once

#include "collision/self/exempt_pairs.h"
#include "core/compute/cuda/scan.h"

namespace toile::collision {

/// ExemptPairs on a GPU. Follows those of the host.
class DeviceExemptPairs {
public:
    /// @param space, exempt  borrowed
    DeviceExemptPairs(const CudaSpace& space, const ExemptPairs& exempt);

    /// Appends the pairs of `found` that are not exempt, in their order. Waits for their number if any pair
    /// may be exempt.
    /// @param kept   its first `count` items stay; grows, with spare capacity
    /// @param count  number of items in use; increased
    void append_kept(View<const NearPair> found, DeviceArray<NearPair>& kept, int& count);

    /// On the device, as of the last append_kept().
    ExemptRule rule() const
    {
        return {rest_.view(),   too_near_,        is_thin_.view(),      crosses_.view(),    crossings_.view(),
                inside_.view(), released_.view(), owner_normal_.view(), body_normal_.view()};
    }

private:
    void follow();

    const CudaSpace& space_;
    const ExemptPairs& exempt_;
    int revision_ = -1;       ///< of exempt_, here on the device
    bool may_exempt_ = false; ///< false: nothing is exempt
    double too_near_;         ///< [m]
    DeviceArray<Vec3> rest_;  ///< this and the others: see ExemptRule
    DeviceArray<unsigned char> is_thin_, crosses_, inside_, released_;
    DeviceArray<BodyCrossing> crossings_;
    DeviceArray<Vec3> owner_normal_, body_normal_;

    DeviceArray<unsigned char> marks_; ///< [found] 1: kept
    DeviceArray<int> indices_;         ///< [found] of the pairs that are kept
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile::collision
