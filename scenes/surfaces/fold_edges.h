#pragma once

#include <vector>

#include "core/mesh/topology.h"
#include "garment/energy/fold/fold_edge.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Edges of a cloth's folds, in their order.
/// @throws InvalidInput in one line that names scene, fold and vertex, for vertices that do not exist or that
///         no edge joins, edges at the border, and edges in two folds
std::vector<garment::FoldEdge> fold_edges(const Scene& scene, const scene::Cloth& settings,
                                          const ClothState& cloth, const Topology& topology);

} // namespace toile::scenes
