#pragma once

#include "collision/self/exempt_pairs.h"
#include "core/compute/cuda/scan.h"

namespace toile::collision {

/// ExemptPairs on a GPU.
class DeviceExemptPairs {
public:
    /// @param space   borrowed
    /// @param exempt  copied
    DeviceExemptPairs(const CudaSpace& space, const ExemptPairs& exempt);

    /// See ExemptPairs::set_crossing.
    void set_crossing(View<const unsigned char> crosses);

    /// Appends the pairs of `found` that are not exempt, in their order. Waits for their number if any pair
    /// may be exempt.
    /// @param kept   its first `count` items stay; grows, with spare capacity
    /// @param count  number of items in use; increased
    void append_kept(View<const NearPair> found, DeviceArray<NearPair>& kept, int& count);

private:
    static bool any(View<const unsigned char> marks);
    ExemptRule rule() const { return {rest_.view(), too_near_, is_thin_.view(), crosses_.view()}; }

    const CudaSpace& space_;
    DeviceArray<Vec3> rest_;
    double too_near_; ///< [m]
    DeviceArray<unsigned char> is_thin_, crosses_;
    bool has_thin_, has_crossing_ = false; ///< both false: nothing is exempt

    DeviceArray<unsigned char> marks_; ///< [found] 1: kept
    DeviceArray<int> indices_;         ///< [found] of the pairs that are kept
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile::collision
