#pragma once

#include "garment/pattern/pattern.h"

namespace toile::garment {

/// Panel and edge of a part as messages name it: front edge 3, front line pocket.
std::string name_of(const Pattern& pattern, const EdgePart& part);

/// Checks that a pattern can be cut and sewn: every panel (check_panel.h), its size, and the seams. Indices
/// of seams must be in range.
/// @throws InvalidInput in one line, FILE: SEAM: ..., for panels of the size of a button or a house (a wrong
///         unit), an edge or part of one in two seams, a chain that does not continue, two labels over a
///         seam, and sides whose lengths cannot be gathered to each other
void require_sewable(const Pattern& pattern);

} // namespace toile::garment
