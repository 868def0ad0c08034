#pragma once

#include <vector>

#include "collision/cloth/exempt_pairs.h"
#include "collision/cloth/pair_watch.h"
#include "collision/cloth/safe_step_kernels.h"
#include "collision/cloth/vertex_set.h"

namespace toile {

/// PairWatch on the CPU. Pairs are looked for again only where the lists may miss one: for vertices that end
/// farther than their slack from where they were expected. What is found serves until the next begin().
class HostPairWatch : public PairWatch {
public:
    /// @param near    of all the vertices; used again by looks; borrowed
    /// @param exempt  pairs that may do as they like; borrowed
    HostPairWatch(NearPairs& near, const ExemptPairs& exempt, const LeastGap& gap)
        : near_(near), exempt_(exempt), gap_(gap)
    {
    }

    /// As SafeStep::begin.
    /// @param base  [vertices] the pose [m]; borrowed
    void begin(View<const Vec3> base, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> pairs);

    /// The first look, where all go to x.
    View<const BlockedPair> look_at_all(View<const Vec3> x);

    View<const BlockedPair> look(View<const ChangedWay> changed) override;

    const LeastGap& gap() const { return gap_; }

private:
    KnownWays known() { return {known_motion_, known_radius_}; }
    void look_around_marked();
    View<const BlockedPair> look_at_pairs();
    const NearPair& pair(int i) const
    {
        return i < expected_pairs_.size() ? expected_pairs_[i] : more_pairs_[i - expected_pairs_.size()];
    }
    int pair_count() const { return expected_pairs_.size() + int(more_pairs_.size()); }

    NearPairs& near_;
    const ExemptPairs& exempt_;
    LeastGap gap_;
    View<const Vec3> base_;
    View<const double> slack_;
    View<const NearPair> expected_pairs_;

    // Since begin().
    std::vector<NearPair> more_pairs_; ///< that the list of begin() does not have
    std::vector<Vec3> known_motion_;   ///< [vertices] that the lists are complete for [m]
    std::vector<double> known_radius_; ///< [vertices] around it [m]

    // Since the first look.
    std::vector<Vec3> motion_;       ///< [vertices] from base_ to where they go [m]
    std::vector<double> pair_share_; ///< [pairs] that one allows

    // Of one look.
    std::vector<unsigned char> is_stale_;  ///< [vertices] goes elsewhere than in the look before
    std::vector<unsigned char> is_marked_; ///< [vertices] goes where the lists aren't complete
    std::vector<NearPair> found_;
    std::vector<BlockedPair> blocked_;
};

} // namespace toile
