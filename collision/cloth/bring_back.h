#pragma once

#include <vector>

#include "collision/cloth/impact_zones.h"
#include "collision/cloth/pair_watch.h"
#include "collision/cloth/rigid_ways.h"
#include "collision/cloth/safe_step_kernels.h"
#include "collision/cloth/tethers.h"

namespace toile {

/// Changes ways until no pair is in its own way, as SafeStep says. Where pairs are, on CPU or GPU, is the
/// PairWatch's affair: it hears whose ways have changed and answers which pairs are in the way then. Costs
/// what is brought back, and a few passes over all vertices and, at each look, over all pairs.
class BringBack {
public:
    struct Settings {
        LeastGap gap;           ///< of pairs
        double most_deflection; ///< [m] SafeStep::Settings
    };

    /// @param edges  of the soup; rigid bodies' are left out
    BringBack(const SurfaceEdges& edges, const Settings& settings, RigidWays bodies);

    /// What is borrowed until the next begin().
    /// @param base   [vertices] the pose that ways begin at [m]
    /// @param fixed  [vertices] 1 where nothing is deflected
    void begin(View<const Vec3> base, View<const unsigned char> fixed);

    /// Changes x [vertices] [m] until the straight way there is free.
    /// @param leans  [vertices] 1 where cloth lies on a body that takes it along; empty: nowhere
    /// @param first  what is in the way to x, of a look of `watch`; not empty
    /// @return the farthest that a vertex was moved [m]
    double limit(View<Vec3> x, View<const unsigned char> leans, PairWatch& watch,
                 View<const BlockedPair> first);

    /// The vertices that the last limit() may have changed.
    View<const int> moved() const { return moved_.items(); }

private:
    void start(View<const Vec3> x);
    void look();
    void deflect();
    bool give_way();
    void give_way_at(const NearPair& pair, double lacking);
    double mobility_of(const NearPair& pair, bool is_first_side) const;
    bool may_give_way(int v) const { return !fixed_[v] && !bodies_.is_rigid(v); }
    void find_shares(View<const unsigned char> leans);
    void shorten(bool for_good);
    void take_along();
    void follow_zones();
    void go(int v, const Vec3& motion);
    bool hold_together(bool for_good);
    void hold_behind(int edge);
    double finish(View<Vec3> x) const;

    Settings settings_;
    RigidWays bodies_;
    Tethers tethers_; ///< edges of cloth
    View<const Vec3> base_;
    View<const unsigned char> fixed_;

    // Of one limit().
    PairWatch* watch_ = nullptr;
    View<const BlockedPair> in_the_way_;  ///< by the last look
    std::vector<Vec3> way_;               ///< [vertices] from base_ to where they want to go [m]
    std::vector<Vec3> motion_;            ///< [vertices] from base_ to where they may go [m]
    std::vector<ImpactZones::Hold> hold_; ///< [vertices]
    ImpactZones zones_;
    VertexSet deflected_;           ///< way_ is not the one that was asked for
    VertexSet moved_;               ///< motion_ is not
    VertexSet stale_;               ///< motion_ has changed since the last look
    VertexSet fresh_;               ///< motion_ has changed since edges were looked at
    std::vector<int> torn_;         ///< edges of tethers_
    std::vector<Vec3> body_motion_; ///< of one body's vertices [m]
    std::vector<ChangedWay> changes_;
};

} // namespace toile
