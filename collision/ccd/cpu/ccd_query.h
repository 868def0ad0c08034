#pragma once

#include <vector>

#include "collision/ccd/ccd_query.h"
#include "collision/ccd/collision_free_step_kernels.h"
#include "collision/ccd/vertex_set.h"
#include "collision/self/exempt_pairs.h"

namespace toile::collision {

/// CcdQuery on the CPU. Pairs are searched for again only where the lists may miss one: for vertices that end
/// farther than their slack from the expected position. The pairs found serve until the next begin().
class CpuCcdQuery : public CcdQuery {
public:
    /// @param near    of all the vertices; used again by updates; borrowed
    /// @param exempt  pairs that are not kept apart; borrowed
    CpuCcdQuery(NearPairs& near, const ExemptPairs& exempt, const MinGap& gap)
        : near_(near), exempt_(exempt), gap_(gap)
    {
    }

    /// See CollisionFreeStep::begin.
    /// @param base  [vertices] start pose [m]; borrowed
    void begin(View<const Vec3> base, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> pairs);

    /// First update: all vertices move to x.
    View<const BlockedPair> query_all(View<const Vec3> x);

    View<const BlockedPair> update(View<const ChangedTrajectory> changed) override;

    const MinGap& gap() const { return gap_; }

private:
    KnownTrajectories known() { return {known_motion_, known_radius_}; }
    void find_near_marked(int count);
    View<const BlockedPair> query_pairs();
    const NearPair& pair(int i) const
    {
        return i < expected_pairs_.size() ? expected_pairs_[i] : more_pairs_[i - expected_pairs_.size()];
    }
    int pair_count() const { return expected_pairs_.size() + int(more_pairs_.size()); }

    NearPairs& near_;
    const ExemptPairs& exempt_;
    MinGap gap_;
    View<const Vec3> base_;
    View<const double> slack_;
    View<const NearPair> expected_pairs_;

    int complete_count_ = 0; ///< pairs after the last complete search

    // Since begin().
    std::vector<NearPair> more_pairs_; ///< missing in the list of begin()
    std::vector<Vec3> known_motion_;   ///< [vertices] see KnownTrajectories [m]
    std::vector<double> known_radius_; ///< [vertices] likewise [m]

    // Since the first update.
    std::vector<Vec3> motion_;          ///< [vertices] displacement from base_ [m]
    std::vector<double> pair_fraction_; ///< [pairs] that each allows

    // Of one update.
    std::vector<unsigned char> is_stale_;  ///< [vertices] trajectory changed since the last update
    std::vector<unsigned char> is_marked_; ///< [vertices] out of bounds
    std::vector<NearPair> found_;
    std::vector<BlockedPair> blocked_;
};

} // namespace toile::collision
