#pragma once

#include <string>

#include "garment/pattern/place/place_panels.h"

namespace toile::garment {

/// How well the placements of a pattern suit a body.
struct PlacementShift {
    double covering = 1.0;     ///< [-] part of the panels' area that has skin behind it, as they are placed
    Vec3 shift = Vec3::Zero(); ///< [m] after which most of it has; zero if none is better
    double covering_shifted = 1.0; ///< [-] after the shift

    /// False if the pattern was drafted for another origin, or does not surround the body anywhere.
    bool fits() const;
};

/// Looks for the origin for which a pattern was placed: the one that it has, the soles of the body, its chest
/// (as bodies of SMPL have it), each also moved horizontally to the body's axis. Panels with `place` don't
/// count. O(sample points x skin).
PlacementShift placement_shift(const Pattern& pattern, const ArrangementSegments& body);

/// One line that says what is wrong with a placement that does not fit, and the shift that mends it.
std::string misplacement_text(const Pattern& pattern, const PlacementShift& placement);

} // namespace toile::garment
