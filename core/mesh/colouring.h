#pragma once

#include <vector>

#include "core/mesh/topology.h"

namespace toile {

/// Colours items so that no two of one colour share a key, greedily in the order of the items. Items of one
/// colour may then write their keys in parallel.
/// @param keys_of_item  keys of each item, in [0, key_count)
/// @return items per colour, ascending
std::vector<std::vector<int>> colour_items(const Incidence& keys_of_item, int key_count);

/// Colours triangles so that no two of one colour share a vertex.
std::vector<std::vector<int>> colour_triangles(View<const Triangle> triangles, int vertex_count);

} // namespace toile
