#pragma once

#include <limits>
#include <vector>

#include "collision/ccd/cpu/ccd_query.h"
#include "collision/ccd/trajectory_limiter.h"

namespace toile::collision {

/// Keeps cloth from crossing cloth, whatever moves it.
///
/// begin() takes a pose without crossings, the expected end of each vertex, and the pairs that could meet in
/// between. limit() then takes any end pose and changes it until the straight trajectories to it are free:
///   1. Deflect. If a pair would come slightly nearer than its minimum gap, its sides move apart along its
///      normal, in a few passes. Pinched cloth thus keeps moving with the bodies that pinch it.
///   2. Limit. The four vertices of a pair that is still blocked join one zone (ImpactZones).
///      max_safe_step() scales down the differences between their displacements and the zone's. If this
///      stretches an edge that is a point to contact, its other end follows (ShortEdges). Zones only grow and
///      fractions only shrink. Vertices that all move alike neither meet nor stretch, so this ends.
///
/// Rigid bodies are never deflected. In a zone they rotate by a fraction of their rotation and move as a
/// whole, rigid to rounding (RigidTrajectories).
///
/// Pairs are searched for again only where the lists may miss one: for vertices that end farther than their
/// slack from the expected position. The pairs found serve every limit() until the next begin(), because most
/// calls have nearly the same pose.
///
/// This is a local form of displacement bounds [Chen et al. 2025, Offset Geometric Contact]. Theirs are
/// spheres, which stop two layers that move together; here pairs are tested.
class CollisionFreeStep {
public:
    struct Settings {
        double min_gap = 2e-6; ///< [m] minimum gap of every pair, above the rounding of exported floats
        double min_gap_fraction = 0.1; ///< [-] of a pair's start distance, or of `thickness`, that remains
        double thickness = 5e-4;       ///< [m] of the thinnest cloth
        double max_deflection = 1e-3;  ///< [m] missing distance up to which a pair is deflected

        /// All vertices from this one on belong to bodies that stand still.
        int first_prescribed = std::numeric_limits<int>::max();

        MinGap gap() const { return {min_gap, min_gap_fraction, thickness}; }
    };

    /// @param near    of all the vertices; used again by limit()
    /// @param exempt  pairs that are not kept apart
    CollisionFreeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings,
                      RigidTrajectories bodies = {});

    /// Starts a step. Reads x and expected; borrows the others until the next begin().
    /// @param x         [vertices] start pose [m]
    /// @param expected  [vertices] expected end positions [m]
    /// @param slack     [vertices] distance from the expected end that `pairs` cover [m]
    /// @param fixed     [vertices] 1: attached cloth, which is limited but not deflected
    /// @param pairs     result of NearPairs::find for these trajectories and a margin of at least
    ///                  `thickness`, without exempt pairs
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const unsigned char> fixed, View<const NearPair> pairs);

    /// Changes x [vertices] [m] where needed.
    /// @param supported  [vertices] 1: cloth on a body that advects it; empty: none
    /// @return maximum correction of a vertex [m]; 0 if x is unchanged, bit for bit
    double limit(View<Vec3> x, View<const unsigned char> supported = {});

    /// Pairs that stopped the trajectories to the x of the last limit().
    View<const BlockedPair> blocked() const { return blocked_; }

    View<const Vec3> base() const { return base_; } ///< [vertices] pose of begin() [m]
    MinGap min_gap() const { return query_.gap(); }

private:
    CpuCcdQuery query_;
    TrajectoryLimiter limiter_;
    std::vector<Vec3> base_;
    std::vector<BlockedPair> blocked_;
};

} // namespace toile::collision
