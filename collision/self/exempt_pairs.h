#pragma once

#include <vector>

#include "collision/self/pair_rules.h"

namespace toile::collision {

/// ExemptPairs for kernels: borrowed fields of host or device.
struct ExemptRule {
    View<const Vec3> rest;             ///< [vertices] [m]
    double too_near;                   ///< [m]
    View<const unsigned char> is_thin; ///< [vertices] around a sliver
    View<const unsigned char> crosses; ///< [vertices] of triangles that cross

    TOILE_HD bool is_exempt(const NearPair& pair) const
    {
        const int first = first_count(pair.is_edge_edge);
        bool crossing[2] = {false, false};
        bool is_near_sliver = false;
        for (int k = 0; k < 4; ++k) {
            bool& side = crossing[k < first ? 0 : 1];
            side = side || crosses[pair.vertex[k]];
            is_near_sliver = is_near_sliver || is_thin[pair.vertex[k]];
        }
        return (crossing[0] && crossing[1]) || (is_near_sliver && is_sliver_pair(pair));
    }

private:
    TOILE_HD bool is_sliver_pair(const NearPair& pair) const
    {
        const std::array<Vec3, 4> x = corners_of(pair.vertex, rest);
        return closest_difference(closest_weights(pair.is_edge_edge, x), x).norm() < too_near;
    }
};

/// Pairs that contact of cloth with cloth ignores, because it could only do harm:
///
/// - Cloth that crosses cloth already (a start pose that could not be repaired, cloth that was moved):
///   contact would keep it on the wrong side. Pairs with vertices of crossing triangles on both sides are
///   exempt until these triangles no longer cross. All other pairs are kept apart, so crossings can move,
///   shrink and vanish, but none begins elsewhere.
/// - Neighbours around slivers in one cloth that are closer in the start pose than a multiple of the minimum
///   gap.
class ExemptPairs {
public:
    /// @param rest       [vertices] start positions [m]
    /// @param altitude   [vertices] shortest altitude of the adjacent triangles [m]
    /// @param min_gap  [m] see CollisionFreeStep
    ExemptPairs(View<const Vec3> rest, View<const double> altitude, double min_gap);

    /// @param crosses  [vertices] 1 for the corners of triangles that cross others; initially none
    void set_crossing(View<const unsigned char> crosses) { crosses_.assign(crosses.begin(), crosses.end()); }

    bool is_exempt(const NearPair& pair) const { return rule().is_exempt(pair); }
    ExemptRule rule() const { return {rest_, too_near_, is_thin_, crosses_}; }

private:
    std::vector<Vec3> rest_;
    double too_near_;                    ///< [m]
    std::vector<unsigned char> is_thin_; ///< [vertices] around a sliver
    std::vector<unsigned char> crosses_; ///< [vertices] of triangles that cross
};

} // namespace toile::collision
