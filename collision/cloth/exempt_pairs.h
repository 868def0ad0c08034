#pragma once

#include <vector>

#include "collision/cloth/near_pairs.h"

namespace toile {

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

    bool is_exempt(const NearPair& pair) const;

private:
    bool is_sliver_pair(const NearPair& pair) const;

    std::vector<Vec3> rest_;
    double too_near_;                    ///< [m]
    std::vector<unsigned char> is_thin_; ///< [vertices] around a sliver
    std::vector<unsigned char> crosses_; ///< [vertices] of triangles that cross
};

} // namespace toile
