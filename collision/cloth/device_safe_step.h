#pragma once

#include "collision/cloth/device_exempt_pairs.h"
#include "collision/cloth/device_near_pairs.h"
#include "collision/cloth/safe_step_kernels.h"

namespace toile {

/// The first look of SafeStep on a GPU: whether all may go straight on, which is what cloth does nearly
/// always. Who may not is brought back on the host.
class DeviceSafeStep {
public:
    /// @param space   borrowed
    /// @param near    searches for those who stray; borrowed
    /// @param exempt  borrowed
    /// @param gap     SafeStep::least_gap()
    DeviceSafeStep(const CudaSpace& space, DeviceNearPairs& near, DeviceExemptPairs& exempt,
                   const LeastGap& gap, int vertex_count);

    /// As SafeStep::begin, all on the device. Pairs are those of near.find, exempt ones among them, and
    /// copied; x and slack are borrowed until the next begin().
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> found);

    /// True where SafeStep::limit would leave x [vertices] [m] as it is, up to the rounding of shares. Waits.
    bool leaves_alone(View<const Vec3> x);

    /// Those of begin(), without the exempt ones, on the device.
    View<const NearPair> pairs() const { return pairs_.view().subview(0, expected_count_); }
    /// The same, to `out` [pairs] of the host: as DeviceArray::download.
    void download_pairs(View<NearPair> out) const { pairs_.download_first(out); }

private:
    KnownWays known() { return {known_motion_.view(), known_radius_.view()}; }
    struct Counts {
        int strays, in_the_way; ///< vertices; pairs
    };
    void count_in_the_way(int first);
    Counts read_counts();

    const CudaSpace& space_;
    DeviceNearPairs& near_;
    DeviceExemptPairs& exempt_;
    LeastGap gap_;
    View<const Vec3> base_;    ///< [vertices] [m]
    View<const double> slack_; ///< [vertices] [m]
    DeviceArray<Vec3> known_motion_;
    DeviceArray<double> known_radius_;
    DeviceArray<NearPair> pairs_; ///< of begin(), then those that the list of begin() does not have
    int expected_count_ = 0, count_ = 0;

    // Of one look.
    DeviceArray<Vec3> way_;                ///< [vertices] [m]
    DeviceArray<unsigned char> marks_;     ///< [vertices] 1: strays
    DeviceArray<int> counts_, block_sums_; ///< Counts; scratch
    PinnedArray<int> read_;                ///< Counts
};

} // namespace toile
