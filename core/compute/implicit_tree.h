#pragma once

#include "core/compute/types.h"

namespace toile {

/// Number of nodes on a level of a binary tree without pointers: node c has the children 2c and 2c + 1 of the
/// level below, as far as they exist.
/// @param lowest  nodes of level 0; if 0, every level is empty
TOILE_HD inline int level_size(int lowest, int level) { return ((lowest - 1) >> level) + 1; }

} // namespace toile
