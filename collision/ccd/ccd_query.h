#pragma once

#include "collision/self/near_pairs.h"

namespace toile::collision {

/// New trajectory of a vertex.
struct ChangedTrajectory {
    int vertex;
    Vec3 displacement; ///< [m]
    double deviation;  ///< [m] from the requested displacement; scales the radius of KnownTrajectories
};

/// A pair whose trajectories come too near each other.
struct BlockedPair {
    NearPair pair;
    double fraction; ///< [-] of its vertices' displacements that it allows, below 1
};

/// Pairs of a CollisionFreeStep and trajectories of their vertices, stored on the host or device that
/// searches for pairs.
class CcdQuery {
public:
    CcdQuery() = default;
    virtual ~CcdQuery() = default;
    CcdQuery(const CcdQuery&) = delete;
    CcdQuery& operator=(const CcdQuery&) = delete;

    /// Finds all blocked pairs after some trajectories have changed, in the same order in every run. Pairs
    /// that the lists may miss are searched for first. Borrowed until the next update.
    /// @param changed  each vertex once
    virtual View<const BlockedPair> update(View<const ChangedTrajectory> changed) = 0;
};

/// CcdQuery that finds all its pairs, for poses on the host.
class CcdSearch : public CcdQuery {
public:
    /// Finds the pairs of the straight trajectories from x to `end`, and all that are blocked.
    /// @param x    [vertices] [m]; borrowed until the next begin()
    /// @param end  [vertices] [m]
    virtual View<const BlockedPair> begin(View<const Vec3> x, View<const Vec3> end) = 0;

    /// Finds all blocked pairs after any trajectories have changed: all vertices move to `end`.
    virtual View<const BlockedPair> query_all(View<const Vec3> end) = 0;
};

} // namespace toile::collision
