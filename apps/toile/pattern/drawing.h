#pragma once

#include <string>

#include "apps/toile/pattern/report.h"

namespace toile::app {

/// Drawing of a pattern as SVG, one unit and one printed millimetre to a millimetre: panels side by side on a
/// grid of centimetres, with name, area and grain; edges with their index and label outside; seams in one
/// colour and number on both sides, with arrows in the direction in which they are sewn.
std::string to_svg(const PatternReport& report);

} // namespace toile::app
