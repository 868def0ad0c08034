#pragma once

#include <vector>

#include "collision/cloth/near_pairs.h"

namespace toile {

/// Keeps cloth from crossing cloth, whatever moves it.
///
/// begin() takes a pose without crossings, how far the vertices are expected to move from it, and all pairs
/// that could meet on the way. limit() then takes any pose and brings it back until the straight way there is
/// free:
///   1. Nobody ends farther than its slack from where it was expected. Pairs that are not on the list stay
///      apart by that alone (NearPairs::find).
///   2. A pair on the list that would come nearer than its least distance is brought back by safe_share(),
///      with all of its four vertices. The share of its way that a vertex goes only ever shrinks, and nobody
///      moves at share 0, so this ends.
/// A rigid body goes one share of its way as a whole, and comes back to its slack as a whole: a blend of two
/// affine images of it, which is one again.
/// A local form of displacement bounds [Chen et al. 2025, Offset Geometric Contact]: theirs are spheres,
/// which stop two layers that move along together; here pairs are asked.
class SafeStep {
public:
    struct Settings {
        double least_gap = 2e-6; ///< [m] that no pair falls below, more than the rounding of exported floats
        double least_share =
            0.1; ///< [-] of a pair's distance at the start, or of `thickness`, that is left of it
        double thickness = 5e-4; ///< [m] of the thinnest cloth
    };

    /// @param rigid  [vertices] number of the rigid body, -1 for none; empty: no such bodies
    explicit SafeStep(const Settings& settings, std::vector<int> rigid = {});

    /// @param x       [vertices] the pose [m]
    /// @param motion  [vertices] expected from there [m]
    /// @param slack   [vertices] beside it [m]
    /// @param pairs   what NearPairs::find has found for the same; borrowed until the next begin(), like
    /// slack
    void begin(View<const Vec3> x, View<const Vec3> motion, View<const double> slack,
               View<const NearPair> pairs);

    /// Brings x [vertices] back where needed.
    /// @return the farthest that a vertex was brought back [m]; 0 when x was left as it is, to the bit
    double limit(View<Vec3> x);

    View<const Vec3> base() const { return base_; } ///< [vertices] the pose of begin() [m]

    int held_count() const { return held_count_; } ///< vertices that the last limit() brought back

private:
    double least_gap_of(const NearPair& pair) const;
    bool is_rigid(int v) const { return !rigid_.empty() && rigid_[v] >= 0; }
    /// Where the share of a vertex stands: its own place, or that of its body behind all vertices.
    int slot(int v) const { return is_rigid(v) ? int(rigid_.size()) + rigid_[v] : v; }
    bool keep_near_expectation(View<Vec3> x);
    bool keep_bodies_near_expectation(View<Vec3> x);
    bool find_shares(View<const Vec3> x);
    void look_at_pairs(View<const Vec3> way);
    bool shorten(bool for_good);

    Settings settings_;
    std::vector<int> rigid_; ///< [vertices], or empty
    int body_count_ = 0;
    View<const double> slack_;
    View<const NearPair> pairs_;
    std::vector<Vec3> base_, expected_;
    std::vector<double> share_;           ///< [slots] of the way from base_
    std::vector<double> pair_share_;      ///< [pairs] that one allows
    std::vector<unsigned char> is_stale_; ///< [slots] share_ has changed since its pairs were looked at
    int held_count_ = 0;
};

} // namespace toile
