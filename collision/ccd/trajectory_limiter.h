#pragma once

#include <limits>
#include <vector>

#include "collision/ccd/ccd_query.h"
#include "collision/ccd/collision_free_step_kernels.h"
#include "collision/ccd/impact_zones.h"
#include "collision/ccd/rigid_trajectories.h"
#include "collision/ccd/short_edges.h"

namespace toile::collision {

/// Changes trajectories until no pair is blocked; see CollisionFreeStep. The CcdQuery stores the pairs, on
/// CPU or GPU: it takes changed trajectories and returns blocked pairs. Cost: proportional to the limited
/// vertices, plus a few passes over all vertices and, per update, over all pairs.
class TrajectoryLimiter {
public:
    struct Settings {
        MinGap gap;            ///< of pairs
        double max_deflection; ///< [m] CollisionFreeStep::Settings

        /// All vertices from this one on belong to bodies, whose motion is prescribed.
        int first_prescribed = std::numeric_limits<int>::max();

        /// Slow cloth is stopped rather than deflected or moved by its zone: resting cloth would creep.
        bool stops_slow = true;
    };

    /// @param edges  of the soup; those of rigid bodies are left out
    TrajectoryLimiter(const SurfaceEdges& edges, const Settings& settings, RigidTrajectories bodies);

    /// Starts a step. The arguments are borrowed until the next begin().
    /// @param base   [vertices] start of the trajectories [m]
    /// @param fixed  [vertices] 1: not deflected
    void begin(View<const Vec3> base, View<const unsigned char> fixed);

    /// Changes x [vertices] [m] until the straight trajectories from base are free.
    /// @param supported  [vertices] 1: cloth on a body that advects it; empty: none
    /// @param first  pairs blocked on the trajectories to x, from `query`; not empty
    /// @return maximum correction of a vertex [m]
    double limit(View<Vec3> x, View<const unsigned char> supported, CcdQuery& query,
                 View<const BlockedPair> first);

    /// Vertices that the last limit() may have changed.
    View<const int> moved() const { return moved_.items(); }

private:
    double slow() const;
    void start(View<const Vec3> x);
    void update_query();
    void deflect();
    bool separate_pairs();
    void separate_pair(const NearPair& pair, const Vec3& apart);
    double mobility_of(const NearPair& pair, bool is_first_side) const;
    bool may_deflect(int v) const { return !fixed_[v] && !bodies_.is_rigid(v); }
    void find_fractions(View<const unsigned char> supported);
    void shorten(bool for_good);
    void keep_short_edges();
    void follow_zones();
    void go(int v, const Vec3& motion);
    bool shorten_edges(bool for_good);
    double finish(View<Vec3> x) const;

    Settings settings_;
    RigidTrajectories bodies_;
    ShortEdges short_edges_; ///< of cloth
    View<const Vec3> base_;
    View<const unsigned char> fixed_;

    // State of one limit().
    CcdQuery* query_ = nullptr;
    View<const BlockedPair> blocked_;           ///< in the last update
    std::vector<Vec3> displacement_;            ///< [vertices] requested, then deflected, from base_ [m]
    std::vector<Vec3> motion_;                  ///< [vertices] allowed, from base_ [m]
    std::vector<ImpactZones::Support> support_; ///< [vertices]
    ImpactZones zones_;
    VertexSet deflected_;            ///< displacement_ differs from the requested one
    VertexSet moved_;                ///< motion_ differs from the requested displacement
    VertexSet stale_;                ///< motion_ has changed since the last update
    VertexSet fresh_;                ///< motion_ has changed since edges were tested
    std::vector<int> overstretched_; ///< edges of short_edges_
    std::vector<Vec3> body_motion_;  ///< of one body's vertices [m]
    std::vector<ChangedTrajectory> changes_;
};

} // namespace toile::collision
