#pragma once

#include "core/backend/types.h"

namespace toile {

/// Nodes on a level of a binary tree without pointers: node c has the children 2c and 2c + 1 of the level
/// below, as far as they exist.
/// @param lowest  nodes of level 0; with none every level is empty
TOILE_HD inline int level_size(int lowest, int level) { return ((lowest - 1) >> level) + 1; }

} // namespace toile
