#pragma once

#include <vector>

#include "core/mesh/topology.h"

namespace toile {

/// A straight way between two vertices within a surface [m].
struct MetricEdge {
    int a = 0, b = 0;
    double length = 0.0;
};

/// Ways along which distances in the undeformed surface are measured: its edges, and across each edge the
/// diagonal of the two triangles laid flat, where that stays inside them. The diagonals keep lengths along a
/// regular grid from depending on the direction: 41 % too long at worst become 8 %.
/// @param triangles   [triangles]
/// @param rest_edges  [triangles] columns x1 - x0, x2 - x0 of the undeformed triangle in its plane [m]
/// @param topology    of the triangles: panels sewn together share their seams' vertices
std::vector<MetricEdge> surface_metric(View<const Triangle> triangles, View<const Mat2> rest_edges,
                                       const Topology& topology);

} // namespace toile
