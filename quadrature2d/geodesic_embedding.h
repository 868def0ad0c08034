#pragma once

#include <vector>

#include "core/quadrature/clusters/cluster_tree.h"
#include "quadrature2d/surface_metric.h"

namespace toile::quadrature2d {

/// Embeds the vertices of a surface so that straight distances approximate those within it. A flat sheet's
/// are within 15 %; a tube's circumference keeps its order, not its length. Handles sewn panels, tubes, holes
/// and branches, independent of the pose. Sheets that touch in space but are not connected stay apart.
///
/// Landmark multidimensional scaling [de Silva & Tenenbaum 2004] of shortest paths along the metric's edges,
/// for each connected piece separately; pieces are placed far from each other. O(landmarks * n log n) per
/// piece.
/// @param vertex_count  n; a vertex without edges is a piece of its own
std::vector<EmbeddedPoint> geodesic_embedding(int vertex_count, View<const MetricEdge> metric);

} // namespace toile::quadrature2d
