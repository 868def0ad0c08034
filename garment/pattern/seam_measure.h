#pragma once

#include "garment/pattern/pattern.h"

namespace toile::garment {

/// Lengths of a seam's sides and how they lie to each other before sewing.
struct SeamMeasure {
    double length_a = 0.0;  ///< [m]
    double length_b = 0.0;  ///< [m]
    double gap = 0.0;       ///< [m] mean distance of the points that are sewn together, as panels are placed
    double other_gap = 0.0; ///< [m] the same if the other ends were joined
    bool crossed = false;   ///< the sides run against each other in space, and would not if flipped

    /// Longer over shorter side [-]: the gather.
    double ratio() const { return length_a > length_b ? length_a / length_b : length_b / length_a; }
};

/// Two curves x(s), y(s) that are sewn have a correlation near 1: they differ by a translation. `crossed`
/// tells that the correlation of the other joining is higher by more than 1, of 2 possible. Seams of less
/// than 3 cm are never called crossed: small ones at armpits and waists truly start so. Neither are those
/// whose sides meet in the tip of a dart or pleat.
SeamMeasure measure_seam(const Pattern& pattern, const Seam& seam);

} // namespace toile::garment
