#pragma once

#include <vector>

#include "collision/cloth/exempt_pairs.h"
#include "collision/cloth/near_pairs.h"
#include "collision/cloth/rigid_ways.h"

namespace toile {

/// Keeps cloth from crossing cloth, whatever moves it.
///
/// begin() takes a pose without crossings, where the vertices are expected to end, and the pairs that could
/// meet on the way. limit() then takes any pose and changes it until the straight way there is free:
///   1. Deflect. Both sides of a pair that would come a little nearer than its least distance give way along
///      its normal, a few times over: cloth in a pinch goes on moving along with what pinches it.
///   2. Bring back what is still in the way: safe_share() shortens the ways of all four vertices of a pair.
///      The share of its way that a vertex goes only ever shrinks, and where nobody moves nobody meets, so
///      this ends.
///
/// Rigid bodies never give way. They go one share of their way as a whole, turning, so that they are still
/// rigid there (RigidWays).
///
/// Pairs are looked for again only where the list of begin() may miss one: for vertices that stray beyond
/// their slack, and around those that are brought back, whom others may now run into.
///
/// A local form of displacement bounds [Chen et al. 2025, Offset Geometric Contact]: theirs are spheres,
/// which stop two layers that move along together; here pairs are asked.
class SafeStep {
public:
    struct Settings {
        double least_gap = 2e-6;  ///< [m] that no pair falls below, more than the rounding of exported floats
        double least_share = 0.1; ///< [-] of a pair's distance at the start, or of `thickness`, that is left
        double thickness = 5e-4;  ///< [m] of the thinnest cloth
        double most_deflection = 1e-3; ///< [m] missing distance up to which both sides of a pair give way
    };

    /// @param near    of all the vertices; used again by limit()
    /// @param exempt  pairs that may do as they like
    /// @param rigid   [vertices] number of the rigid body, -1 for none; empty: no such bodies
    SafeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings,
             const std::vector<int>& rigid = {})
        : near_(near), exempt_(exempt), settings_(settings), bodies_(rigid)
    {
    }

    /// All arguments but x are borrowed until the next begin().
    /// @param x         [vertices] the pose [m]
    /// @param expected  [vertices] where they are expected to end [m]
    /// @param slack     [vertices] beside it [m]
    /// @param fixed     [vertices] 1 where nothing is deflected: held cloth, which can only be brought back
    /// @param pairs     what NearPairs::find has found for the same with a margin of at least `thickness`,
    ///                  without the exempt ones
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const unsigned char> fixed, View<const NearPair> pairs);

    /// Changes x [vertices] where needed.
    /// @return the farthest that a vertex was moved [m]; 0 when x was left as it is, to the bit
    double limit(View<Vec3> x);

    View<const Vec3> base() const { return base_; } ///< [vertices] the pose of begin() [m]

private:
    double least_gap_of(const NearPair& pair) const;
    bool mark_strays(View<const Vec3> x);
    void look_around_marked();
    const NearPair& pair(int i) const
    {
        return i < expected_pairs_.size() ? expected_pairs_[i] : more_pairs_[i - expected_pairs_.size()];
    }
    int pair_count() const { return expected_pairs_.size() + int(more_pairs_.size()); }
    void look_at_pairs();
    void deflect();
    bool give_way();
    double mobility_of(const NearPair& pair, bool is_first_side) const;
    bool may_give_way(int v) const { return !fixed_[v] && !bodies_.is_rigid(v); }
    bool shorten(bool for_good);
    void find_shares();
    void go_shares();

    NearPairs& near_;
    const ExemptPairs& exempt_;
    Settings settings_;
    RigidWays bodies_;
    View<const Vec3> expected_;
    View<const double> slack_;
    View<const unsigned char> fixed_;
    View<const NearPair> expected_pairs_;
    std::vector<Vec3> base_;

    // Of one limit().
    std::vector<NearPair> more_pairs_;        ///< that the list of begin() does not have
    std::vector<NearPair> found_pairs_;       ///< by the last look
    std::vector<Vec3> way_;                   ///< [vertices] from base_ to where they want to go [m]
    std::vector<double> share_;               ///< [vertices] of the way; a body's is that of its leader
    std::vector<Vec3> going_;                 ///< [vertices] the way that it makes [m]
    std::vector<double> pair_share_;          ///< [pairs] that one allows
    std::vector<double> least_share_;         ///< [vertices, leaders] that the lists know of
    std::vector<Vec3> least_;                 ///< [vertices] the way that it makes [m]
    std::vector<unsigned char> is_deflected_; ///< [vertices] way_ is not the one that was asked for
    std::vector<unsigned char> is_marked_;    ///< [vertices] for look_around_marked()
    std::vector<unsigned char>
        is_stale_; ///< [vertices, leaders] share_ has changed since its pairs were looked at
    bool has_marked_ = false;
};

} // namespace toile
