#pragma once

#include <vector>

#include "garment/pattern/pattern.h"

namespace toile::garment {

/// How the outer sides of panels continue across seams.
struct SewnSides {
    /// [panels] true: the panel is sewn with its inner side out, as a lapel is
    std::vector<bool> turned;
    /// Seams that make the surface one-sided (a Moebius strip): the outer side of one panel continues as the
    /// inner side of the other. Empty if the sewn surface has two sides.
    std::vector<int> one_sided;
};

/// Sides of the sewn surface. A seam continues the outer side if its edges run against each other round their
/// loops. If no choice of turned panels makes all seams do so, panels stay as they are but where turning one
/// leaves fewer such seams.
SewnSides sewn_sides(const Pattern& pattern);

} // namespace toile::garment
