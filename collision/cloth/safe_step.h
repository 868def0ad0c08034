#pragma once

#include <vector>

#include "collision/cloth/bring_back.h"
#include "collision/cloth/host_pair_watch.h"

namespace toile {

/// Keeps cloth from crossing cloth, whatever moves it.
///
/// begin() takes a pose without crossings, where the vertices are expected to end, and the pairs that could
/// meet on the way. limit() then takes any pose and changes it until the straight way there is free:
///   1. Deflect. Both sides of a pair that would come a little nearer than its least distance give way along
///      its normal, a few times over: cloth in a pinch goes on moving along with what pinches it.
///   2. Bring back what is still in the way: the four vertices of a pair join in a zone (ImpactZones), and
///      safe_share() shortens what their ways differ from its. An edge of cloth that this would tear takes
///      its other end along (Tethers). Zones only grow and shares only shrink, and where all move alike
///      nobody meets and nothing tears, so this ends.
///
/// Rigid bodies never give way; in a zone they turn by less and move as a whole, rigid to rounding
/// (RigidWays).
///
/// Pairs are looked for again only where the lists may miss one: for vertices that end farther than their
/// slack from where they were expected, whatever has taken them there. What is found serves every limit()
/// until the next begin(): most ask for nearly the same pose again.
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

        LeastGap gap() const { return {least_gap, least_share, thickness}; }
    };

    /// @param near    of all the vertices; used again by limit()
    /// @param exempt  pairs that may do as they like
    SafeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings, RigidWays bodies = {});

    /// x and expected are read, the others borrowed until the next begin().
    /// @param x         [vertices] the pose [m]
    /// @param expected  [vertices] where they are expected to end [m]
    /// @param slack     [vertices] beside it [m]
    /// @param fixed     [vertices] 1 where nothing is deflected: held cloth, which can only be brought back
    /// @param pairs     what NearPairs::find has found for the same with a margin of at least `thickness`,
    ///                  without the exempt ones
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const unsigned char> fixed, View<const NearPair> pairs);

    /// Changes x [vertices] where needed.
    /// @param leans  [vertices] 1 where cloth lies on a body that takes it along; empty: nowhere
    /// @return the farthest that a vertex was moved [m]; 0 when x was left as it is, to the bit
    double limit(View<Vec3> x, View<const unsigned char> leans = {});

    View<const Vec3> base() const { return base_; } ///< [vertices] the pose of begin() [m]
    LeastGap least_gap() const { return watch_.gap(); }

private:
    HostPairWatch watch_;
    BringBack bring_back_;
    std::vector<Vec3> base_;
};

} // namespace toile
