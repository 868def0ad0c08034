#pragma once

#include <vector>

#include "collision/cloth/near_pairs.h"

namespace toile {

/// Keeps cloth from crossing cloth, whatever moves it.
///
/// begin() takes a pose without crossings, where the vertices are expected to end, and the pairs that could
/// meet on the way. limit() then takes any pose and brings it back until the straight way there is free: a
/// pair that would come nearer than its least distance is shortened by safe_share(), for all of its four
/// vertices. The share of its way that a vertex goes only ever shrinks, and where nobody moves nobody meets,
/// so this ends.
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
    };

    /// @param near  of all the vertices; used again by limit()
    SafeStep(NearPairs& near, const Settings& settings) : near_(near), settings_(settings) {}

    /// All arguments but x are borrowed until the next begin().
    /// @param x         [vertices] the pose [m]
    /// @param expected  [vertices] where they are expected to end [m]
    /// @param slack     [vertices] beside it [m]
    /// @param pairs     what NearPairs::find has found for the same, with a margin of at least `thickness`
    void begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
               View<const NearPair> pairs);

    /// Brings x [vertices] back where needed.
    /// @return the farthest that a vertex was brought back [m]; 0 when x was left as it is, to the bit
    double limit(View<Vec3> x);

    View<const Vec3> base() const { return base_; } ///< [vertices] the pose of begin() [m]

private:
    double least_gap_of(const NearPair& pair) const;
    bool strays(View<const Vec3> x) const;
    void look_again();
    void look_at_pairs();
    bool shorten(bool for_good);
    bool find_shares();

    NearPairs& near_;
    Settings settings_;
    View<const Vec3> expected_;
    View<const double> slack_;
    View<const NearPair> expected_pairs_;
    std::vector<Vec3> base_;

    // Of one limit().
    View<const NearPair> pairs_;          ///< the list in use
    std::vector<NearPair> found_pairs_;   ///< what look_again() has found
    std::vector<Vec3> way_;               ///< [vertices] from base_ to where they want to go [m]
    std::vector<double> share_;           ///< [vertices] of the way
    std::vector<double> pair_share_;      ///< [pairs] that one allows
    std::vector<double> strays_;          ///< [vertices] how far one may end from its whole way [m]
    std::vector<unsigned char> is_stale_; ///< [vertices] share_ has changed since its pairs were looked at
    bool has_lag_ = false;                ///< a vertex lags behind that the list in use does not know of
};

} // namespace toile
