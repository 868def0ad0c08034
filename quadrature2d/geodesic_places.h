#pragma once

#include <vector>

#include "core/quadrature/cluster_tree.h"
#include "quadrature2d/surface_metric.h"

namespace toile {

/// Puts the vertices of a surface where straight distances are about those within it (a flat sheet's to 15 %,
/// a tube's circumference keeps its order, not its length): panels sewn
/// together, tubes, holes and branches alike, whatever pose the cloth is in. Sheets that touch in space but
/// not in the cloth stay apart.
///
/// Landmark multidimensional scaling [de Silva & Tenenbaum 2004] of shortest paths along the metric's ways,
/// each connected piece by itself; pieces are put far from each other. O(landmarks * n log n) for each piece.
/// @param vertex_count  n; a vertex without ways is a piece of its own
std::vector<Place> geodesic_places(int vertex_count, View<const MetricEdge> metric);

} // namespace toile
