#pragma once

#include "collision/cloth/exempt_pairs.h"
#include "core/backend/cuda/scan.h"

namespace toile {

/// ExemptPairs on a GPU.
class DeviceExemptPairs {
public:
    /// @param space   borrowed
    /// @param exempt  copied
    DeviceExemptPairs(const CudaSpace& space, const ExemptPairs& exempt);

    /// As ExemptPairs.
    void set_crossing(View<const unsigned char> crosses);

    /// Appends those of `found` that are not exempt, in their order. Waits for their number where any may be.
    /// @param kept   its first `count` items stay; grows, with room for more
    /// @param count  of the items in use; changed
    void append_kept(View<const NearPair> found, DeviceArray<NearPair>& kept, int& count);

private:
    static bool any(View<const unsigned char> marks);
    ExemptRule rule() const { return {rest_.view(), too_near_, is_thin_.view(), crosses_.view()}; }

    const CudaSpace& space_;
    DeviceArray<Vec3> rest_;
    double too_near_; ///< [m]
    DeviceArray<unsigned char> is_thin_, crosses_;
    bool has_thin_, has_crossing_ = false; ///< none: nothing is exempt

    DeviceArray<unsigned char> marks_; ///< [found] 1: kept
    DeviceArray<int> places_;          ///< [found] of those that are kept
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile
