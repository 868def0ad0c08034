#pragma once

#include "garment/pattern/pattern.h"

namespace toile::garment {

/// Checks that a panel's edges bound a piece of cloth.
/// @param source  file, for messages
/// @throws InvalidInput in one line, FILE: panel "front", edge 3: ..., for a loop that is open or not one, an
///         edge without length, an arc that does not reach its ends, a loop that crosses or touches itself,
///         and a panel without area
void require_cuttable(const Panel& panel, const std::string& source);

} // namespace toile::garment
