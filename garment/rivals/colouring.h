#pragma once

#include <vector>

#include "core/mesh/topology.h"

namespace toile {

/// The blocks of one colour in a list of blocks laid out colour by colour.
struct BlockRange {
    int first, count;
};

/// Colours items so that no two of one colour share a key, greedily in the order of the items: what one
/// colour writes, none of its other items reads.
/// @param keys_of_item  per item the keys it holds, in [0, key_count)
/// @return items per colour, ascending
std::vector<std::vector<int>> colour_items(const Incidence& keys_of_item, int key_count);

} // namespace toile
