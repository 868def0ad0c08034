#pragma once

#include <string>
#include <vector>

#include "core/mesh/topology.h"
#include "garment/energy/fold/fold_edge.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Edges of a cloth's folds, in their order.
/// @param key_path  of the list, for messages
/// @throws InvalidInput in one line that names fold and vertex, for vertices that do not exist or that
///         no edge joins, edges at the border, and edges in two folds
std::vector<garment::FoldEdge> fold_edges(const std::vector<scene::Fold>& folds, const ClothState& cloth,
                                          const Topology& topology, const std::string& key_path);

} // namespace toile::scenes
