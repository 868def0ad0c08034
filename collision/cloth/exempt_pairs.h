#pragma once

#include <vector>

#include "collision/cloth/pair_rules.h"

namespace toile {

/// ExemptPairs for kernels: borrowed fields, of the host or on a GPU.
struct ExemptRule {
    View<const Vec3> rest;             ///< [vertices] [m]
    double too_near;                   ///< [m]
    View<const unsigned char> is_thin; ///< [vertices] around a sliver
    View<const unsigned char> crosses; ///< [vertices] of triangles that cross

    TOILE_HD bool is_exempt(const NearPair& pair) const
    {
        const int first = first_count(pair.is_edge_edge);
        bool crossing[2] = {false, false};
        bool is_around_sliver = false;
        for (int k = 0; k < 4; ++k) {
            bool& side = crossing[k < first ? 0 : 1];
            side = side || crosses[pair.vertex[k]];
            is_around_sliver = is_around_sliver || is_thin[pair.vertex[k]];
        }
        return (crossing[0] && crossing[1]) || (is_around_sliver && is_sliver_pair(pair));
    }

private:
    TOILE_HD bool is_sliver_pair(const NearPair& pair) const
    {
        const std::array<Vec3, 4> x = corners_of(pair.vertex, rest);
        return closest_difference(closest_weights(pair.is_edge_edge, x), x).norm() < too_near;
    }
};

/// Pairs that contact of cloth with cloth leaves alone, because it could only do harm:
///
/// - Cloth that crosses cloth already (a start pose that could not be repaired, cloth that was put
/// elsewhere):
///   what lies on the wrong side would be kept there. Pairs of which both sides touch a crossing triangle
///   are free until no triangle around them crosses; everything else is held apart as ever, so crossings can
///   move on, shrink and vanish, but none begins elsewhere.
/// - Neighbours in one cloth that are nearer at rest than the least gap: slivers.
class ExemptPairs {
public:
    /// @param rest       [vertices] start positions [m]
    /// @param altitude   [vertices] shortest altitude of the triangles around [m]
    /// @param least_gap  [m] see SafeStep
    ExemptPairs(View<const Vec3> rest, View<const double> altitude, double least_gap);

    /// @param crosses  [vertices] 1 for the corners of triangles that cross others; at first none
    void set_crossing(View<const unsigned char> crosses) { crosses_.assign(crosses.begin(), crosses.end()); }

    bool is_exempt(const NearPair& pair) const { return rule().is_exempt(pair); }
    ExemptRule rule() const { return {rest_, too_near_, is_thin_, crosses_}; }

private:
    std::vector<Vec3> rest_;
    double too_near_;                    ///< [m]
    std::vector<unsigned char> is_thin_; ///< [vertices] around a sliver
    std::vector<unsigned char> crosses_; ///< [vertices] of triangles that cross
};

} // namespace toile
