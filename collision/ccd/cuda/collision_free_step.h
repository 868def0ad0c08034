#pragma once

#include "collision/ccd/collision_free_step_kernels.h"
#include "collision/self/cuda/async_near_pairs.h"
#include "collision/self/cuda/exempt_pairs.h"

namespace toile::collision {

/// CcdQuery on a GPU: all pairs, trajectories and searches stay on the device. The first update of a step
/// nearly always finds no blocked pair. Otherwise TrajectoryLimiter on the host makes further updates: only
/// the trajectories that it changes and the blocked pairs cross the bus.
class DeviceCollisionFreeStep : public CcdQuery {
public:
    /// @param space   borrowed
    /// @param near    searches for vertices out of bounds; borrowed
    /// @param exempt  borrowed
    DeviceCollisionFreeStep(const CudaSpace& space, AsyncNearPairs& near, DeviceExemptPairs& exempt,
                            const MinGap& gap, int vertex_count);

    /// See CollisionFreeStep::begin; all arrays on the device. `found` has the pairs of `near`, including
    /// exempt ones, and is copied. x and slack are borrowed until the next begin().
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> found);

    /// After a search has failed: takes all trajectories for unknown until the next search.
    void forget_known();

    /// First update: all vertices move to x [vertices] [m], on the device. Empty if CollisionFreeStep::limit
    /// would not change x, up to the rounding of fractions. Waits.
    /// @throws TooManyPairs, as update(); forget_known() must follow
    View<const BlockedPair> query_all(View<const Vec3> x);

    /// Waits for the result.
    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override;

    /// Pairs of begin() without the exempt ones, on the device.
    View<const NearPair> pairs() const { return pairs_.view().subview(0, expected_count_); }

private:
    KnownTrajectories known() { return {known_motion_.view(), known_radius_.view()}; }
    struct Counts {
        int out_of_bounds, blocked; ///< vertices; pairs
    };
    int find_near_marked(int count);
    void count_blocked(int known);
    Counts read_counts();
    View<const BlockedPair> list_blocked();

    const CudaSpace& space_;
    AsyncNearPairs& near_;
    DeviceExemptPairs& exempt_;
    MinGap gap_;
    View<const Vec3> base_;    ///< [vertices] [m]
    View<const double> slack_; ///< [vertices] [m]
    DeviceArray<Vec3> known_motion_;
    DeviceArray<double> known_radius_;
    DeviceArray<NearPair> pairs_; ///< of begin(), then those found since
    int expected_count_ = 0, count_ = 0;
    int complete_count_ = 0; ///< pairs after the last complete search

    // Of one update and those after it.
    DeviceArray<Vec3> displacement_;        ///< [vertices] [m]
    DeviceArray<unsigned char> is_blocked_; ///< [pairs]

    // Of one update.
    DeviceArray<unsigned char> is_stale_; ///< [vertices] 1: trajectory changed since the last update
    DeviceArray<unsigned char> marks_;    ///< [vertices] 1: out of bounds
    PinnedArray<int> counts_;             ///< Counts
    DeviceArray<int> block_sums_;         ///< scratch
    DeviceArray<int> indices_;            ///< of blocked pairs
    PinnedArray<int> listed_;
    DeviceScratch scratch_;
    DeviceArray<ChangedTrajectory> changed_;
    PinnedArray<ChangedTrajectory> host_changed_; ///< staging of changed_
    DeviceArray<BlockedPair> blocked_;
    PinnedArray<BlockedPair> host_blocked_; ///< staging of blocked_
};

} // namespace toile::collision
