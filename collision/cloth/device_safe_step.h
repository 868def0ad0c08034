#pragma once

#include "collision/cloth/async_near_pairs.h"
#include "collision/cloth/device_exempt_pairs.h"
#include "collision/cloth/safe_step_kernels.h"

namespace toile {

/// PairWatch on a GPU, where all pairs, ways and searches stay. The first look of a step says whether all may
/// go straight on, which is what cloth does nearly always. Where not, BringBack on the host asks on: over the
/// bus go the ways that it changes and the pairs that are in the way.
class DeviceSafeStep : public PairWatch {
public:
    /// @param space   borrowed
    /// @param near    searches for those who stray; borrowed
    /// @param exempt  borrowed
    DeviceSafeStep(const CudaSpace& space, AsyncNearPairs& near, DeviceExemptPairs& exempt,
                   const LeastGap& gap, int vertex_count);

    /// As SafeStep::begin, all on the device. Pairs are those of near.find, exempt ones among them, and
    /// copied; x and slack are borrowed until the next begin().
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> found);

    /// The first look, where all go to x [vertices] [m], on the device: empty where SafeStep::limit would
    /// leave x as it is, up to the rounding of shares. Waits.
    View<const BlockedPair> look_at_all(View<const Vec3> x);

    /// Waits.
    View<const BlockedPair> look(View<const ChangedWay> changed) override;

    /// Those of begin(), without the exempt ones, on the device.
    View<const NearPair> pairs() const { return pairs_.view().subview(0, expected_count_); }

private:
    KnownWays known() { return {known_motion_.view(), known_radius_.view()}; }
    struct Counts {
        int strays, in_the_way; ///< vertices; pairs
    };
    void look_around_marked(int count);
    void count_in_the_way(int known);
    Counts read_counts();
    View<const BlockedPair> list_in_the_way();

    const CudaSpace& space_;
    AsyncNearPairs& near_;
    DeviceExemptPairs& exempt_;
    LeastGap gap_;
    View<const Vec3> base_;    ///< [vertices] [m]
    View<const double> slack_; ///< [vertices] [m]
    DeviceArray<Vec3> known_motion_;
    DeviceArray<double> known_radius_;
    DeviceArray<NearPair> pairs_; ///< of begin(), then those that the list of begin() does not have
    int expected_count_ = 0, count_ = 0;

    // Of one look and those after it.
    DeviceArray<Vec3> way_;                    ///< [vertices] [m]
    DeviceArray<unsigned char> is_in_the_way_; ///< [pairs]

    // Of one look.
    DeviceArray<unsigned char> is_stale_; ///< [vertices] 1: goes elsewhere than in the look before
    DeviceArray<unsigned char> marks_;    ///< [vertices] 1: strays
    PinnedArray<int> counts_;             ///< Counts
    DeviceArray<int> block_sums_;         ///< scratch
    DeviceArray<int> places_;             ///< of pairs in the way
    PinnedArray<int> listed_;
    DeviceScratch scratch_;
    DeviceArray<ChangedWay> changed_;
    PinnedArray<ChangedWay> host_changed_; ///< the first of them, as many as there are
    DeviceArray<BlockedPair> blocked_;
    PinnedArray<BlockedPair> host_blocked_; ///< the first of them
};

} // namespace toile
